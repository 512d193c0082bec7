# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The running controller, played to by a test that is the robot."""

import signal
import time
from dataclasses import replace

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns, to_ns
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

MODEL = RobotModel()
GRAVITY = MODEL.gravity(panda().home).copy()


class Robot:
    """A robot that stands still at the reference and asks for torques."""

    def __init__(self, observer, sources_are_heard=True):
        self.observer = observer
        self.commands = observer.listen(contract.EFFORT_COMMANDS)
        self.applied = observer.listen(contract.APPLIED_WRENCH)
        self.parts = [observer.listen(contract.HUMAN_APPLIED), observer.listen(contract.AGENT_APPLIED)]
        self.states = observer.publisher(contract.JOINT_STATES)
        self.human = observer.publisher(contract.HUMAN_WRENCH)
        self.agent = observer.publisher(contract.AGENT_WRENCH)
        self.now_ns = time.time_ns() // 20_000_000 * 20_000_000
        observer.spin(lambda: all(p.get_subscription_count() for p in (self.states, self.human, self.agent)))
        if sources_are_heard:
            self._be_heard(self.human)
            self._be_heard(self.agent)

    def _be_heard(self, source):
        """Discovery has two sides: send until the controller shows that it listens."""
        for m_y in (0.125, 0.0):
            for _ in range(100):
                self.send(source, m_y)
                self.tick_once()
                if self.applied and bool(self.applied[-1].wrench.torque.y) == bool(m_y):
                    break
            else:
                raise AssertionError('the controller does not hear its sources')

    def tick_once(self, **changes):
        """Publish the next tick; an answer may or may not come."""
        self.now_ns += 1_000_000
        self.states.publish(self.state(**changes))
        self.observer.spin_for(0.05)

    def state(self, **changes):
        message = JointState(
            name=list(panda().joints), position=panda().home.tolist(), velocity=[0.0] * 7, effort=GRAVITY.tolist())
        for name, value in changes.items():
            setattr(message, name, value)
        set_ns(message.header.stamp, self.now_ns)
        return message

    def tick(self, **changes):
        """Publish the next tick and give the torque that answers it."""
        self.now_ns += 1_000_000
        count = len(self.commands)
        self.states.publish(self.state(**changes))
        self.observer.spin(lambda: len(self.commands) > count)
        return np.array(self.commands[-1].data)

    def send(self, publisher, m_y, age=0.0, frame=contract.BASE_FRAME, m_x=0.0):
        message = WrenchStamped()
        message.header.frame_id = frame
        message.wrench.torque.x, message.wrench.torque.y = m_x, m_y
        set_ns(message.header.stamp, self.now_ns - int(age * 1e9))
        publisher.publish(message)
        time.sleep(0.05)

    def used(self):
        """The sum at this tick and its parts, human and agent, as published, N m."""
        messages = (self.applied, *self.parts)
        self.observer.spin(lambda: all(m and to_ns(m[-1].header.stamp) == self.now_ns for m in messages))
        assert {m[-1].header.frame_id for m in messages} == {contract.BASE_FRAME}
        return [m[-1].wrench.torque.y for m in messages]

    def moment(self):
        """M_y that the torque of the next tick contains, N m."""
        lever = MODEL.jacobian(panda().home)[4]
        return float((self.tick() - GRAVITY) @ lever / (lever @ lever))


def expected(m_y):
    return ComputedTorqueController(RobotModel()).torque(panda().home, np.zeros(7), GRAVITY, np.array([m_y]))


@pytest.fixture(scope='class')
def node(start_node):
    return start_node('torque_ctrl_node', enabled=True)


@pytest.fixture(scope='class')
def robot(node, observer):
    return Robot(observer)


class TestRunningController:
    """One controller for all: it keeps nothing from tick to tick."""

    @pytest.fixture(autouse=True)
    def silence(self, robot):
        robot.now_ns += 1_000_000_000

    def test_sums_the_moments_of_human_and_agent(self, robot):
        np.testing.assert_array_equal(robot.tick(), expected(0.0))
        robot.send(robot.human, 0.5)
        robot.send(robot.agent, -0.2)
        np.testing.assert_array_equal(robot.tick(), expected(0.3))
        assert robot.used() == [-0.2 + 0.5, 0.5, -0.2]

    def test_unchanged_moments_are_published_every_ten_ticks(self, robot):
        robot.tick()
        begin_ns = robot.now_ns
        for _ in range(30):
            robot.tick()
        robot.observer.spin_for(0.1)
        total, human, agent = (
            [stamp for message in messages if (stamp := to_ns(message.header.stamp)) > begin_ns]
            for messages in (robot.applied, *robot.parts))
        assert total == human == agent and 3 <= len(total) <= 4

    def test_the_sum_and_the_torque_rate_are_limited(self, robot):
        robot.send(robot.human, 1000.0)
        torque = robot.tick()
        assert np.abs(torque - GRAVITY).max() <= 1.0 + 1e-12
        assert robot.used() == [20.0, 1000.0, 0.0], 'the parts are those before the limit'

    def test_a_silent_source_fades_to_nothing(self, robot):
        robot.send(robot.human, 0.5)
        full = robot.moment()
        assert full > 0.1
        robot.now_ns += 140_000_000
        assert 0.0 < robot.moment() < full
        total, human, agent = robot.used()
        assert 0.0 < human < 0.5 and (total, agent) == (human, 0.0)
        robot.now_ns += 200_000_000
        assert robot.moment() == pytest.approx(0.0, abs=1e-9)
        assert robot.used() == [0.0, 0.0, 0.0]

    def test_a_moment_counts_no_longer_when_time_is_set_back(self, robot):
        robot.send(robot.human, 0.5)
        np.testing.assert_array_equal(robot.tick(), expected(0.5))
        robot.now_ns -= 500_000_000
        np.testing.assert_array_equal(robot.tick(), expected(0.0))
        assert robot.used() == [0.0, 0.0, 0.0]
        robot.now_ns += 499_000_000
        np.testing.assert_array_equal(
            robot.tick(), expected(0.0), err_msg='it came back with the time at which it was sent')

    @pytest.mark.parametrize(('fault', 'said'), [
        ({'m_y': float('nan')}, 'torque.y is nan'),
        ({'m_y': 1e300}, 'torque.y is 1e+300'),
        ({'m_y': float('-inf')}, 'torque.y is -inf'),
        ({'m_y': 0.5, 'frame': 'world'}, "frame_id is 'world'"),
        ({'m_y': 0.5, 'age': 0.5}, 'old, more than command_timeout'),
        ({'m_y': 0.5, 'age': -5.0}, 'use_sim_time'),
    ])
    def test_untrustworthy_wrenches_are_dropped_and_named(self, node, robot, fault, said):
        time.sleep(1.0)  # an error is said once a second
        robot.send(robot.human, **fault)
        np.testing.assert_array_equal(robot.tick(), expected(0.0))
        node.wait_for_log(said)
        assert 'dropped a message on /human/target_wrench' in node.log()

    def test_a_component_that_the_task_does_not_share_counts_nothing_and_is_named(self, node, robot):
        robot.send(robot.agent, 0.5, m_x=2.0)
        np.testing.assert_array_equal(robot.tick(), expected(0.5))
        node.wait_for_log('/agent/target_wrench: torque.x is 2.0 and counts nothing: the task shares torque.y')

    @pytest.mark.parametrize(('broken', 'said'), [
        ({'position': [0.0] * 3}, 'position has 3 values'),
        ({'effort': [0.0, 0.0, 1000.0, 0.0, 0.0, 0.0, 0.0]}, 'effort of panda_joint3 is 1000 N m'),
    ])
    def test_broken_joint_states_get_no_answer(self, node, robot, broken, said):
        time.sleep(1.0)  # an error is said once a second
        answers = len(robot.commands)
        robot.now_ns += 1_000_000
        robot.states.publish(robot.state(**broken))
        node.wait_for_log(f'dropped a message on /joint_states: {said}')
        assert len(robot.commands) == answers
        robot.tick()

    @pytest.mark.parametrize('stamp_ns', [-1_000_000, -2**31 * 10**9])
    def test_joint_states_of_a_time_that_no_robot_has_get_no_answer(self, node, robot, stamp_ns):
        time.sleep(1.0)  # an error is said once a second
        robot.tick()
        answers, now_ns = len(robot.commands), robot.now_ns
        robot.now_ns = stamp_ns
        robot.states.publish(robot.state())
        node.wait_for_log(f"/joint_states: its stamp is {stamp_ns * 1e-9:.3f} s: no robot's time is negative")
        robot.now_ns = now_ns
        robot.tick()
        assert len(robot.commands) == answers + 1

    def test_an_answer_says_what_it_answers_and_a_repeated_tick_gets_the_same(self, robot):
        robot.tick()
        robot.states.publish(robot.state())
        count = len(robot.commands)
        robot.observer.spin(lambda: len(robot.commands) == count + 1)
        first, again = robot.commands[-2:]
        assert int(first.layout.dim[0].label) == robot.now_ns
        assert first == again

    def test_says_once_a_second_how_it_fares(self, robot):
        robot.send(robot.human, 0.0)
        robot.tick()
        robot.now_ns += 1_000_000_000
        reports = robot.observer.listen(contract.DIAGNOSTICS)
        deadline = time.monotonic() + 60.0
        while not reports and time.monotonic() < deadline:
            robot.tick()
        status = reports[0].status[0]
        assert {'period_p50_ms', 'period_p99_ms', 'overruns'} <= {value.key for value in status.values}
        assert '/human/target_wrench: silent for' in status.message


@pytest.fixture(scope='class')
def disabled(start_node):
    return start_node('torque_ctrl_node', robot_compensates_gravity=True)


@pytest.fixture(scope='class')
def robot_at_rest(disabled, observer):
    return Robot(observer, sources_are_heard=False)


class TestSafety:
    """A controller that nobody has enabled, from one state to the next."""

    def ask(self, robot, service, request=None):
        return robot.observer.call(type_of(request), f'controller/{service}', request or Trigger.Request())

    def answers(self, robot, ticks=3, **state):
        """The torques that answer some ticks."""
        count = len(robot.commands)
        for _ in range(ticks):
            robot.tick_once(effort=[0.0] * 7, **state)
        return [np.array(m.data) for m in robot.commands[count:]]

    def wait_for_silence(self, robot):
        for _ in range(100):
            for _ in range(50):
                robot.now_ns += 1_000_000
                robot.states.publish(robot.state(effort=[0.0] * 7))
                time.sleep(0.001)
            robot.observer.spin_for(0.05)
            if not self.answers(robot):
                return
        pytest.fail('it goes on sending torques')

    def enable(self, robot, **state):
        self.answers(robot, **state)
        return self.ask(robot, 'enable', SetBool.Request(data=True))

    def test_starts_disabled_and_says_how_to_go_on(self, disabled, robot_at_rest):
        disabled.wait_for_log('disabled: /controller/enable to go on')
        assert self.answers(robot_at_rest) == []

    def test_is_not_enabled_far_from_the_reference(self, robot_at_rest):
        far = panda().home + [0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
        response = self.enable(robot_at_rest, position=far.tolist())
        assert not response.success and 'panda_joint4 is 0.50 rad off' in response.message
        assert self.answers(robot_at_rest) == []

    def test_enabled_it_answers_and_disabled_it_brings_the_arm_to_rest_and_falls_silent(self, robot_at_rest):
        assert self.enable(robot_at_rest).success
        robot_at_rest.tick(effort=[0.0] * 7)
        assert self.ask(robot_at_rest, 'enable', SetBool.Request(data=False)).success
        torque = robot_at_rest.tick(effort=[0.0] * 7, velocity=[0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
        assert torque[1] == -1.0, 'against the motion, as fast as the rate of the torque allows'
        np.testing.assert_allclose(robot_at_rest.tick(effort=[0.0] * 7), np.zeros(7), atol=1e-9)
        self.wait_for_silence(robot_at_rest)

    def test_what_was_sent_to_a_disabled_one_before_time_was_set_back_never_counts(self, robot_at_rest):
        sent_ns = robot_at_rest.now_ns
        robot_at_rest.observer.spin(robot_at_rest.human.get_subscription_count)
        robot_at_rest.send(robot_at_rest.human, 0.5)
        robot_at_rest.now_ns -= 500_000_000
        assert self.enable(robot_at_rest).success
        robot_at_rest.now_ns = sent_ns
        np.testing.assert_allclose(robot_at_rest.tick(effort=[0.0] * 7), np.zeros(7), atol=1e-9)
        assert self.ask(robot_at_rest, 'enable', SetBool.Request(data=False)).success
        self.wait_for_silence(robot_at_rest)

    @pytest.mark.parametrize('how', ['service', contract.EMERGENCY_STOP.qos, contract.qos_unreliable(10)],
                             ids=['service', 'topic', 'unreliable topic'])
    def test_the_emergency_stop_wins_until_it_is_reset(self, robot_at_rest, how):
        assert self.enable(robot_at_rest).success
        reports = robot_at_rest.observer.listen(contract.DIAGNOSTICS)
        if how == 'service':
            assert self.ask(robot_at_rest, 'emergency_stop').success
        else:
            publisher = robot_at_rest.observer.publisher(replace(contract.EMERGENCY_STOP, qos=how))

        def stopped():
            if how != 'service':  # again and again: the first of an unreliable one may be lost
                publisher.publish(Bool(data=True))
                publisher.publish(Bool(data=False))
            self.answers(robot_at_rest)
            return any(r.status[0].level == DiagnosticStatus.ERROR and r.status[0].message.startswith(
                '/effort_controller/commands: emergency stop: /controller/reset_emergency_stop, then') for r in reports)

        robot_at_rest.observer.spin(stopped)
        if how != 'service':
            robot_at_rest.observer.node.destroy_publisher(publisher)
            self.answers(robot_at_rest, 20)  # it has heard all that was sent
        refused = self.enable(robot_at_rest)
        assert not refused.success and 'reset_emergency_stop first' in refused.message
        assert self.ask(robot_at_rest, 'reset_emergency_stop').success
        self.wait_for_silence(robot_at_rest)
        assert self.enable(robot_at_rest).success
        robot_at_rest.tick(effort=[0.0] * 7)
        assert self.ask(robot_at_rest, 'enable', SetBool.Request(data=False)).success


def type_of(request):
    return Trigger if request is None else SetBool


@pytest.mark.parametrize(('sharing', 'used'), [('override', [0.5, 0.5, 0.0]), ('blend', [0.05, 0.125, -0.075])])
def test_what_counts_of_the_moments_is_a_parameter(start_node, observer, sharing, used):
    start_node('torque_ctrl_node', enabled=True, sharing=sharing, blend_weight=0.25)
    robot = Robot(observer)
    robot.now_ns += 1_000_000_000
    robot.send(robot.human, 0.5)
    robot.send(robot.agent, -0.1)
    np.testing.assert_allclose(robot.tick(), expected(used[0]), atol=1e-9)
    assert robot.used() == pytest.approx(used)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_leaves_cleanly(start_node, number):
    node = start_node('torque_ctrl_node')
    node.wait_for_log('ready')
    assert node.stop(number) == 0
    assert 'Traceback' not in node.log()


@pytest.mark.parametrize(('parameters', 'said'), [
    ({'gains': 'stiff'}, "'gains' has no choice 'stiff'"),
    ({'command_timeout': 5.0}, "'command_timeout'"),
    ({'moment_limit': 'much'}, "'moment_limit'"),
    ({'sharing': 'axes'}, 'sharing: axes are divided between person and robot only where a task has two'),
])
def test_wrong_parameters_are_named(start_node, parameters, said):
    node = start_node('torque_ctrl_node', **parameters)
    assert node.process.wait(60) == 2
    assert said in node.log() and 'Traceback' not in node.log()
