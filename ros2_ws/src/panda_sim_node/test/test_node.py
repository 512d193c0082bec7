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

"""The running simulator, with the real controller or with a test that answers its ticks."""

import signal
from itertools import groupby

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from panda_sim_node.node import LEARNER_LEFT_AFTER
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import BallStarts
from shared_control_ros import contract
from shared_control_ros.stamps import to_ns
from shared_control_ros.torque_command import torque_command
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger


def stamps_ms(messages):
    return np.array([to_ns(m.header.stamp) for m in messages]) // 1_000_000


def pause(observer, paused, service=contract.PAUSE_SERVICE):
    assert observer.call(SetBool, service, SetBool.Request(data=paused)).success


def set_parameters(observer, *parameters):
    """Results of the simulator's own service."""
    request = SetParameters.Request(parameters=[parameter.to_parameter_msg() for parameter in parameters])
    return observer.call(SetParameters, contract.SEED_SERVICE, request).results


@pytest.fixture(scope='class')
def states(start_node, observer):
    states = observer.listen(contract.JOINT_STATES, depth=10_000)
    start_node('panda_sim_node', paced=False, seed=7)
    start_node('torque_ctrl_node', enabled=True)
    observer.spin(lambda: len(states) > 500, what='the loop runs')
    return states


class TestLockstepWithController:
    """Unpaced lockstep with torque_ctrl_node."""

    def test_every_tick_has_the_next_stamp(self, observer, states):
        balls, clocks = observer.listen(contract.BALL), observer.listen(contract.CLOCK)
        observer.spin(lambda: len(balls) > 20 and len(clocks) > 20)
        # A tick that nobody answered while discovery went on stands there twice.
        steps = np.diff(stamps_ms(states))
        assert set(steps) <= {0, 1} and (steps[100:] == 1).all()
        assert set(np.diff(stamps_ms(balls))) == {10}
        assert balls[0].header.frame_id == contract.BASE_FRAME

    def test_a_pause_that_a_person_asks_for_while_the_learner_rests_stays(self, observer, states):
        pause(observer, True, contract.REST_SERVICE)
        pause(observer, True)
        pause(observer, False, contract.REST_SERVICE)
        observer.spin_for(0.3)
        count = len(states)
        observer.spin_for(0.3)
        assert len(states) == count
        pause(observer, True, contract.REST_SERVICE)
        pause(observer, False)
        observer.spin_for(0.3)
        assert len(states) == count
        pause(observer, False, contract.REST_SERVICE)
        observer.spin(lambda: len(states) > count)
        assert observer.call(Trigger, contract.RESET_SERVICE, Trigger.Request()).success, 'the learner has left since'

    def test_time_goes_on_once_the_learner_for_whom_it_stands_still_has_left(self, observer, states):
        reports = observer.listen(contract.DIAGNOSTICS)

        def told():
            return [v.value for r in reports for v in r.status[0].values if v.key == 'at_rest'][-1:]
        learner = observer.publisher(contract.AGENT_WRENCH)
        pause(observer, True, contract.REST_SERVICE)
        observer.spin_for(LEARNER_LEFT_AFTER + 1.0)
        count = len(states)
        observer.spin_for(0.3)
        assert len(states) == count, 'the learner is there, however long it takes'
        assert told() == ['True']
        answer = observer.call(SetBool, contract.PAUSE_SERVICE, SetBool.Request(data=False))
        assert answer.message == 'at rest for the learner'
        observer.node.destroy_publisher(learner)
        observer.spin(lambda: len(states) > count, what='time goes on')
        observer.spin(lambda: told() == ['False'])

    def test_pause_stops_time_at_a_policy_tick_and_reset_starts_there(self, observer, states):
        balls = observer.listen(contract.BALL)
        pause(observer, True)
        observer.spin_for(0.3)
        count = len(states)
        observer.spin_for(0.3)
        assert len(states) == count
        assert (stamps_ms(states)[-1] + 1) % 20 == 0
        seeded, = set_parameters(observer, Parameter('seed', value=7))
        assert seeded.successful
        assert observer.call(Trigger, contract.RESET_SERVICE, Trigger.Request()).success
        balls.clear()
        pause(observer, False)
        observer.spin(lambda: balls)
        assert balls[0].pose.pose.position.x == BallStarts(BALANCE, 7).next()[0]
        assert balls[0].pose.pose.position.z == 0.94
        assert stamps_ms(balls)[0] % 20 == 0
        observer.spin(lambda: len(states) > count + 50)
        assert (np.diff(stamps_ms(states[count - 10:])) == 1).all()

    def test_the_simulators_service_takes_a_valid_seed_and_no_other_parameter(self, observer, states):
        results = set_parameters(
            observer, Parameter('seed', value=-1), Parameter('seed', value='one'), Parameter('paced', value=True),
            Parameter('seed', value=8))
        assert [result.successful for result in results] == [False, False, False, True]
        assert "takes seed alone, not 'paced'" in results[2].reason

    def test_a_parameter_of_no_type_that_there_is_is_refused(self, observer, states):
        strange = Parameter('seed', value=8).to_parameter_msg()
        strange.value.type = 99
        for name in (contract.SEED_SERVICE, '/panda_sim_node/set_parameters'):
            [result] = observer.call(SetParameters, name, SetParameters.Request(parameters=[strange])).results
            assert not result.successful and "nothing is set: parameter 'seed': 99" in result.reason
        request = SetParametersAtomically.Request(parameters=[strange])
        assert not observer.call(
            SetParametersAtomically, '/panda_sim_node/set_parameters_atomically', request).result.successful
        seeded, = set_parameters(observer, Parameter('seed', value=7))
        assert seeded.successful, 'the node lives'

    def test_a_push_tilts_the_tray_while_it_lasts(self, observer, states):
        assert observer.call(Trigger, contract.RESET_SERVICE, Trigger.Request()).success
        publisher = observer.publisher(contract.DISTURBANCE)
        push = WrenchStamped()
        push.header.frame_id = contract.BASE_FRAME
        push.wrench.force.z = -50.0
        still = np.array(states[-1].position)

        def moved():
            publisher.publish(push)
            return np.abs(np.array(states[-1].position) - still).max() > 0.01

        observer.spin(moved)
        for _ in range(50):
            observer.spin_for(0.05)
            if np.abs(np.array(states[-1].position) - still).max() < 0.005:
                break
        else:
            pytest.fail('the push did not end')
        push.wrench.force.z = 1e160
        publisher.publish(push)
        observer.spin_for(0.3)
        assert np.abs(np.array(states[-1].position) - still).max() < 0.005, 'pushed as nobody can'

    def test_a_pause_is_reported_at_once(self, observer, states):
        reports = observer.listen(contract.DIAGNOSTICS)
        for paused in [True, False] * 4:
            pause(observer, paused)
        told = []

        def is_told():
            paused = [v.value for r in reports for v in r.status[0].values if v.key == 'paused']
            told[:] = [value for value, _ in groupby(paused)]
            return told[-8:] == ['True', 'False'] * 4
        observer.spin(is_told, what=f'every pause (told: {told})')

    def test_reports_its_pace(self, observer, states):
        reports = observer.listen(contract.DIAGNOSTICS)
        observer.spin(lambda: any(r.status[0].name == '/panda_sim_node' for r in reports))
        report = next(r for r in reports if r.status[0].name == '/panda_sim_node')
        values = {v.key: v.value for v in report.status[0].values}
        assert int(values['ticks']) > 500 and float(values['tick_p99_ms']) >= float(values['tick_p50_ms']) > 0


class TestLockstepAnsweredByHand:
    """The test itself is the controller."""

    def test_waits_repeats_and_refuses_bad_torques(self, start_node, observer):
        states = observer.listen(contract.JOINT_STATES)
        commands = observer.publisher(contract.EFFORT_COMMANDS)
        node = start_node('panda_sim_node', paced=False)
        observer.spin(lambda: len(states) >= 3, what='the first tick, again and again')
        assert len(set(stamps_ms(states))) == 1
        pause(observer, True)  # it answers without a controller
        pause(observer, False)
        observer.spin(lambda: commands.get_subscription_count() == 1)
        bad = ([0.0] * 6, [0.0] * 6 + [float('nan')])
        for data in bad:
            commands.publish(Float64MultiArray(data=data))
            observer.spin_for(1.1)
        assert node.log().count('dropped a message on /effort_controller/commands') == 2
        assert len(set(stamps_ms(states))) == 1
        before = stamps_ms(states)[0]
        commands.publish(Float64MultiArray(data=[1e9] * 7))
        observer.spin(lambda: stamps_ms(states)[-1] == before + 1)
        assert list(states[-1].effort) == [87.0] * 4 + [12.0] * 3
        node.wait_for_log('until the controller answers')

    def test_an_answer_that_comes_twice_is_not_that_of_the_next_tick(self, start_node, observer):
        states = observer.listen(contract.JOINT_STATES)
        commands = observer.publisher(contract.EFFORT_COMMANDS)
        start_node('panda_sim_node', paced=False)
        observer.spin(lambda: states and commands.get_subscription_count() == 1)
        torque = list(states[-1].effort)
        tick = to_ns(states[-1].header.stamp)
        for _ in range(2):
            commands.publish(torque_command([value + 0.25 for value in torque], tick))
        observer.spin(lambda: to_ns(states[-1].header.stamp) == tick + 1_000_000)
        repeated = len(states)
        observer.spin(lambda: len(states) > repeated + 2, what='the second tick, again and again')
        assert to_ns(states[-1].header.stamp) == tick + 1_000_000
        commands.publish(torque_command(torque, tick + 1_000_000))
        observer.spin(lambda: to_ns(states[-1].header.stamp) == tick + 2_000_000)
        assert list(states[-1].effort) == torque


def test_it_answers_at_whatever_tick_the_controller_has_left_it(start_node, observer):
    states, balls = observer.listen(contract.JOINT_STATES), observer.listen(contract.BALL)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    start_node('panda_sim_node', paced=False, seed=7)
    observer.spin(lambda: states and commands.get_subscription_count() == 1)

    def newest_ns():
        return to_ns(states[-1].header.stamp)

    def answer():
        tick = newest_ns()
        commands.publish(torque_command(list(states[-1].effort), tick))
        observer.spin(lambda: newest_ns() > tick)

    for _ in range(7):
        answer()
    left_ns = newest_ns()
    assert left_ns % 20_000_000 == 7_000_000
    pause(observer, True)
    pause(observer, False)
    answer()
    assert newest_ns() == left_ns + 1_000_000, 'time goes on where it stood'

    balls.clear()
    assert observer.call(Trigger, contract.RESET_SERVICE, Trigger.Request()).success
    observer.spin(lambda: balls)
    assert to_ns(balls[-1].header.stamp) == left_ns + 13_000_000, 'the next policy tick'
    assert balls[-1].pose.pose.position.z == 0.94
    observer.spin(lambda: newest_ns() == left_ns + 13_000_000)
    answer()
    assert newest_ns() == left_ns + 14_000_000


@pytest.mark.parametrize('fault', ['no torques', 'the answer to another tick'])
def test_unusable_torques_without_end_hold_up_nothing(start_node, observer, fault):
    states, reports = observer.listen(contract.JOINT_STATES), observer.listen(contract.DIAGNOSTICS)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    bad = Float64MultiArray(data=[float('nan')] * 7) if fault == 'no torques' else torque_command([0.0] * 7, 1)
    node = start_node('panda_sim_node', paced=False)
    observer.spin(lambda: states and commands.get_subscription_count() == 1)

    def flood():
        commands.publish(bad)
        observer.spin_for(0.02)  # far less than until the tick is published again

    node.wait_for_log('until the controller answers', timeout=120.0, beside=flood)
    states.clear()
    reports.clear()
    while len(states) < 3 or len(reports) < 2:
        assert node.process.poll() is None, node.log()
        flood()
    assert observer.call(Trigger, contract.RESET_SERVICE, Trigger.Request(), beside=flood).success


def test_free_running_goes_on_without_torques_on_its_brakes(start_node, observer):
    states, reports = observer.listen(contract.JOINT_STATES), observer.listen(contract.DIAGNOSTICS)
    start_node('panda_sim_node', mode='free_running')
    observer.spin(lambda: len(states) > 1000 and len(reports) > 1)
    assert (np.diff(stamps_ms(states)) == 1).all()
    drift = np.abs(np.array(states[-1].position) - np.array(states[0].position)).max()
    assert drift < 0.01
    values = {v.key: v.value for v in reports[-1].status[0].values}
    assert int(values['missed_commands']) > 500


def test_free_running_keeps_torques_within_the_joints_limits(start_node, observer):
    states, commands = observer.listen(contract.JOINT_STATES), observer.publisher(contract.EFFORT_COMMANDS)
    start_node('panda_sim_node', mode='free_running')
    observer.spin(lambda: states and commands.get_subscription_count() == 1)
    commands.publish(Float64MultiArray(data=[1e9] * 7))
    observer.spin(lambda: any(list(m.effort) == [87.0] * 4 + [12.0] * 3 for m in states))


@pytest.mark.parametrize(('robot', 'parameters'), [
    ('panda_sim_node', {'mode': 'free_running'}), ('mock_panda_node', {'drop_rate': 0.0})])
def test_a_robot_that_runs_freely_takes_no_answers_to_joint_states_of_another(
        start_node, observer, robot, parameters):
    states, commands = observer.listen(contract.JOINT_STATES), observer.publisher(contract.EFFORT_COMMANDS)
    start_node(robot, **parameters)
    observer.spin(lambda: states and commands.get_subscription_count() == 1)

    def last_joint(torque, late_ns):
        """Whether the torque about the last joint has become this."""
        effort = list(states[-1].effort)
        commands.publish(torque_command([*effort[:6], torque], to_ns(states[-1].header.stamp) - late_ns))
        return any(message.effort[6] == torque for message in states)

    observer.spin(lambda: last_joint(0.125, 0), what='an answer')
    for late_ns in (-60 * 10**9, 60 * 10**9, 500_000_000):  # another robot's, or older than command_timeout
        for _ in range(50):
            assert not last_joint(0.25, late_ns)
            observer.spin_for(0.01)
    observer.spin(lambda: last_joint(0.375, 3_000_000), what='an answer that is some ticks late')


def test_free_running_is_controlled(start_node, observer):
    states, commands = observer.listen(contract.JOINT_STATES), observer.listen(contract.EFFORT_COMMANDS)
    start_node('panda_sim_node', mode='free_running')
    start_node('torque_ctrl_node', enabled=True, prediction_horizon=0.004)
    observer.spin(lambda: len(commands) > 1000)
    q = np.array([m.position for m in states])
    assert np.abs(q - q[0]).max() < 0.02
    assert np.abs(np.diff([m.effort for m in states], axis=0)).max() < 40.0


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_leaves_cleanly(start_node, number):
    node = start_node('panda_sim_node')
    node.wait_for_log('ready')
    assert node.stop(number) == 0
    assert 'Traceback' not in node.log()


@pytest.mark.parametrize(('parameters', 'said'), [
    ({'mode': 'backwards'}, "'mode' has no choice 'backwards'"),
    ({'ball_mass': 100.0}, "'ball_mass'"),
    ({'seed': 'one'}, "'seed'"),
])
def test_wrong_parameters_are_named(start_node, parameters, said):
    node = start_node('panda_sim_node', **parameters)
    assert node.process.wait(60) == 2
    assert said in node.log() and 'Traceback' not in node.log()


def test_physics_that_are_not_installed_are_named(start_node, tmp_path, monkeypatch):
    (tmp_path / 'mujoco.py').write_text("raise ModuleNotFoundError('not here', name='mujoco')")
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    node = start_node('panda_sim_node', physics='mujoco')
    assert node.process.wait(60) == 2
    assert 'error: ' in node.log() and 'pip install "shared-control[mujoco]"' in node.log()
    assert 'Traceback' not in node.log()
