"""The graph on the mock of a real Panda: the same tests as with the simulator, and what only a robot does.

The mock runs with its jitter and losses, at a fifth of its pace, since a test machine is no real-time machine.
"""

import time
from itertools import pairwise

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
from ppo_agent_node.graph_plant import GraphPlant
from shared_control.env import SharedControlEnv
from shared_control.plant import PlantInterrupted
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from shared_control_ros.stamps import to_ns
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger

LATE = {'enabled': True, 'prediction_horizon': 0.01}
ROBOTS = {
    'panda_sim_node': ({'paced': False, 'seed': 3}, {'enabled': True, 'wait_for': ['agent']}),
    'mock_panda_node': ({'pace': 0.2, 'seed': 3}, {**LATE, 'robot_compensates_gravity': True}),
}
STEPS = 150
"""3 s: when nobody balances it, the ball lies at the end of the tray by then."""


def balance(observation):
    """A law made by hand: the tilt that brings the ball to the centre, from error, velocity and pitch; (1,)."""
    error, velocity, pitch = observation * [0.2, 0.3, 0.1]
    return np.array([np.clip((-2.1 + 100.0 * (0.6 * error - 0.45 * velocity - pitch)) / 8.0, -1.0, 1.0)])


class Robot:
    """A robot, the controller, and the agent's end of the graph in this process."""

    def __init__(self, observer, start_node, package):
        parameters, controller = ROBOTS[package]
        self.observer = observer
        self.states = observer.listen(contract.JOINT_STATES, depth=10_000)
        self.balls = observer.listen(contract.BALL)
        self.reports = observer.listen(contract.DIAGNOSTICS)
        # Whatever it is called: services are named after the role.
        self._nodes = [start_node('torque_ctrl_node', **controller),
                       start_node(package, name='some_robot', **parameters)]
        self._background = Background(observer.node)
        self.env = SharedControlEnv(GraphPlant(observer.node, BALANCE.axes, self._background, observer.take_all))
        self.env.plant.wait_until_up()

    def balance(self, steps):
        """Drop the ball and balance it; position errors, m, and velocities, m/s, of each step."""
        for _ in range(10):
            observation, info = self.env.reset(seed=5)
            states = [info['state']]
            self.states.clear()
            try:
                while len(states) <= steps:
                    observation, _, fallen, _, info = self.env.step(balance(observation))
                    states.append(info['state'])
                    assert not fallen
            except PlantInterrupted:  # the machine was busy for a second: the agent begins anew, too
                continue
            if not self._has_braked():
                return [s.position_error for s in states], [s.velocity for s in states]
        raise AssertionError('ten times the machine was too busy')

    def _has_braked(self):
        """Whether the control ended meanwhile: the machine was so busy that no torques came for 0.1 s of the robot."""
        moved = [any(m.effort) for m in self.states]
        return any(before and not after for before, after in pairwise(moved))

    def balance_until(self, condition):
        """Drop the ball and balance it until something is the case."""
        observation, _ = self.env.reset(seed=5)
        for _ in range(1000):
            if condition():
                return
            try:
                observation = self.env.step(balance(observation))[0]
            except PlantInterrupted:  # as above
                observation, _ = self.env.reset(seed=5)
            self.observer.take_all()
        raise AssertionError('20 s were not enough')

    def spin(self, until, what=''):
        self.observer.spin(until, 60.0, what)

    def call(self, service_type, name, request):
        """The node is the background's while a plant uses it."""
        client = self.observer.node.create_client(service_type, name)
        assert client.wait_for_service(20.0), name
        future = client.call_async(request)
        for _ in range(400):
            self._background.spin_once(0.05)
            if future.done():
                return future.result()
        raise AssertionError(f'no answer of {name}')

    def said(self, key):
        """The values that the robot's diagnostics gave for ``key``."""
        return [v.value for r in self.reports if r.status[0].name == '/some_robot'
                for v in r.status[0].values if v.key == key]

    def close(self):
        self.env.close()
        self._background.close()
        for node in self._nodes:
            node.stop()


@pytest.fixture(scope='class', params=tuple(ROBOTS))
def robot(request, observer, start_node):
    robot = Robot(observer, start_node, request.param)
    yield robot
    robot.close()


@pytest.fixture(scope='class')
def mock(observer, start_node):
    robot = Robot(observer, start_node, 'mock_panda_node')
    yield robot
    robot.close()


class TestEveryRobot:
    """Simulator and mock alike."""

    def test_a_policy_keeps_the_ball_within_all_limits(self, robot):
        error, velocity = robot.balance(STEPS)
        assert abs(error[0]) > 0.1 and abs(error[-1]) < 0.06 and abs(velocity[-1]) < 0.08
        assert 'reflex' not in robot.said('mode')

        q, qd, torque = (np.array([getattr(m, field) for m in robot.states])
                         for field in ('position', 'velocity', 'effort'))
        assert (q >= panda().q_min).all() and (q <= panda().q_max).all()
        assert (np.abs(qd) <= panda().qd_max).all()
        assert (np.abs(torque) <= panda().torque_max).all()
        within_rate = (np.abs(np.diff(torque, axis=0)) <= 1.0 + 1e-6).all(axis=1)
        following = np.diff([to_ns(m.header.stamp) for m in robot.states]) == 1_000_000
        assert within_rate[following].all(), '1000 N m/s'

    def test_nobody_else_puts_an_episode_back(self, robot):
        robot.env.reset(seed=5)
        refused = robot.call(Trigger, contract.RESET_SERVICE, Trigger.Request())
        assert not refused.success and '/learner/repeat starts it over' in refused.message
        robot.env.plant.rest()
        assert robot.call(Trigger, contract.RESET_SERVICE, Trigger.Request()).success, 'there is no episode'

    def test_topics_are_those_of_the_contract(self, robot):
        robot.balance_until(lambda: len(robot.balls) > 5 and robot.states)
        assert list(robot.states[-1].name) == list(panda().joints)
        assert robot.balls[-1].header.frame_id == robot.states[-1].header.frame_id == contract.BASE_FRAME
        stamps = [to_ns(m.header.stamp) for m in robot.balls]
        assert all(stamp % 10_000_000 == 0 for stamp in stamps) and stamps == sorted(stamps)

    def test_a_push_tilts_the_tray(self, robot):
        publisher = robot.observer.publisher(contract.DISTURBANCE)
        push = WrenchStamped()
        push.header.frame_id = contract.BASE_FRAME
        push.wrench.force.z = -30.0

        def moved():
            publisher.publish(push)
            return robot.states and np.abs(np.array(robot.states[-1].position) - panda().home).max() > 0.02

        robot.balance_until(moved)


class TestOnlyARobot:
    """What the mock has ahead of the simulator."""

    def test_it_loses_commands_and_goes_on(self, mock):
        mock.env.reset(seed=1)
        mock.spin(lambda: (mock.said('dropped_commands') and int(mock.said('dropped_commands')[-1]) > 3
                           and mock.said('mode')[-1] == 'move'))

    def test_time_does_not_stand_still(self, mock):
        response = mock.call(SetBool, contract.PAUSE_SERVICE, SetBool.Request(data=True))
        assert not response.success and 'does not stand still' in response.message
        count = len(mock.states)
        mock.spin(lambda: len(mock.states) > count + 50)

    def test_a_violated_limit_stops_it_until_it_is_told_to_recover(self, mock):
        publisher = mock.observer.publisher(contract.EFFORT_COMMANDS)
        wild = Float64MultiArray(data=[0.0] * 6 + [500.0])

        def stopped():
            for _ in range(50):  # another source of torques that outdoes the controller
                publisher.publish(wild)
                time.sleep(0.0003)
            return mock.said('mode')[-1] == 'reflex'

        mock.spin(stopped, 'a reflex stop')
        report = next(r.status[0] for r in reversed(mock.reports) if r.status[0].name == '/some_robot')
        assert report.level == DiagnosticStatus.ERROR
        assert 'violation: ' in report.message and '/robot/error_recovery' in report.message
        mock.observer.node.destroy_publisher(publisher)

        count = len(mock.states)
        mock.spin(lambda: len(mock.states) > count + 300)
        assert np.abs(mock.states[-1].velocity).max() < 1e-3 and mock.said('mode')[-1] == 'reflex'
        assert not any(mock.states[-1].effort)

        assert mock.call(Trigger, contract.ERROR_RECOVERY_SERVICE, Trigger.Request()).success
        assert not mock.call(Trigger, contract.ERROR_RECOVERY_SERVICE, Trigger.Request()).success
        mock.spin(lambda: mock.said('mode')[-1] == 'move', 'control goes on')
        error, _ = mock.balance(STEPS)
        assert abs(error[-1]) < 0.5 * abs(error[0]), 'it rolls inwards'
        assert mock.said('mode')[-1] == 'move'
