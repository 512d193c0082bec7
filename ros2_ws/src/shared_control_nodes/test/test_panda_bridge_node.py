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

"""The bridge without an arm: what it refuses, and its wiring.

panda-python is no requirement of this project, and no arm is connected to a test machine: a small stand-in for that
library (stand_in/) takes its place. Where the real one is installed, its calls are compared with those of the stand-in.
"""

import importlib.util
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.stamps import to_ns
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger

STAND_IN = Path(__file__).parent / 'stand_in'


@pytest.fixture(scope='class')
def with_stand_in():
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('PYTHONPATH', str(STAND_IN))
        yield


def test_without_the_library_it_says_what_to_install(start_node, tmp_path, monkeypatch):
    (tmp_path / 'panda_py.py').write_text('raise ImportError("not here")')
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    node = start_node('panda_bridge_node', hostname='nobody')
    assert node.process.wait(60) == 2
    assert 'error: panda-python cannot be imported (not here): pip install panda-python' in node.log()
    assert 'Traceback' not in node.log()


@pytest.mark.parametrize(('hostname', 'said'), [
    ({}, "error: parameter 'hostname' is missing"),
    ({'hostname': 'nobody'}, 'error: no Panda at nobody: libfranka: Connection to FCI refused.'),
])
def test_without_an_arm_it_says_so(with_stand_in, start_node, hostname, said):
    node = start_node('panda_bridge_node', **hostname)
    assert node.process.wait(60) == 2
    assert said in node.log() and 'Traceback' not in node.log()


def test_beside_another_robot_it_is_refused_and_the_other_beside_it(with_stand_in, start_node):
    simulator = start_node('panda_sim_node')
    simulator.wait_for_log('ready')
    refused = start_node('panda_bridge_node', hostname='here')
    assert refused.process.wait(60) == 2
    assert f'process {simulator.process.pid} (python -m panda_sim_node) is the robot in ROS domain' in refused.log()
    assert 'Traceback' not in refused.log()
    assert simulator.stop() == 0
    bridge = start_node('panda_bridge_node', hostname='here')
    bridge.wait_for_log('ready')
    refused = start_node('panda_sim_node')
    assert refused.process.wait(60) == 2
    assert f'process {bridge.process.pid} (python -m shared_control_nodes.bridge) is the robot in' in refused.log()


@pytest.mark.skipif(importlib.util.find_spec('panda_py') is None, reason='pip install panda-python==1.1.1')
def test_the_stand_in_has_the_calls_of_the_library():
    from panda_py import Panda, controllers, libfranka
    with pytest.raises(RuntimeError, match='libfranka'):
        Panda('127.0.0.1')
    for name in ('get_state', 'start_controller', 'stop_controller', 'raise_error', 'recover'):
        assert callable(getattr(Panda, name))
    controllers.AppliedTorque().set_control(np.zeros(7))
    for name in ('time', 'q', 'dq', 'tau_J_d', 'robot_mode'):
        assert hasattr(libfranka.RobotState, name)
    assert {'kIdle', 'kMove', 'kReflex'} <= libfranka.RobotMode.__members__.keys()
    assert callable(libfranka.Duration.to_msec)


@pytest.fixture(scope='class')
def states(with_stand_in, start_node, observer):
    states = observer.listen(contract.JOINT_STATES, depth=10_000)
    start_node('panda_bridge_node', hostname='here', command_timeout=1.0)  # a busy machine is no silence
    observer.spin(lambda: len(states) > 100)
    return states


@pytest.fixture(scope='class')
def commands(states, observer):
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    observer.spin(commands.get_subscription_count)
    return commands


def enable(observer, data=True, beside=lambda: None):
    return observer.call(SetBool, 'robot/enable', SetBool.Request(data=data), beside=beside)


def enable_beside(observer, commands, torque):
    """Enable while torques come; refused until the first has found its way."""
    deadline = time.monotonic() + 60.0
    while not (response := enable(observer, beside=lambda: commands.publish(Float64MultiArray(data=torque)))).success:
        assert 'no torques' in response.message and time.monotonic() < deadline, response.message


class TestWiring:
    """The bridge on the stand-in."""

    def send(self, observer, commands, torque, until):
        """Torques again and again."""
        def sent():
            commands.publish(Float64MultiArray(data=torque))
            return until()
        observer.spin(sent)

    def test_states_are_those_of_the_arm(self, states):
        assert list(states[-1].name) == list(panda().joints)
        stamps = np.array([to_ns(m.header.stamp) for m in states])
        assert (stamps % 1_000_000 == 0).all() and (np.diff(stamps) > 0).all()

    def test_throttled_states_are_those_of_every_10_ms(self, observer, states):
        """The agent finds the joints that belong to a ball by its stamp."""
        throttled = observer.listen(contract.JOINT_STATES_THROTTLE)
        observer.spin(lambda: len(throttled) > 50)
        assert all(to_ns(m.header.stamp) % 10_000_000 == 0 for m in throttled)

    def test_nothing_moves_before_a_person_enables_it(self, observer, states, commands):
        refused = enable(observer)
        assert not refused.success and 'enable the controller first' in refused.message
        count = len(states)
        self.send(observer, commands, [0.0] * 6 + [0.5], lambda: len(states) > count + 100)
        assert not any(states[-1].effort)

    def test_enabled_it_applies_torques_until_they_fall_silent(self, observer, states, commands):
        enable_beside(observer, commands, [0.0] * 6 + [0.001])
        self.send(observer, commands, [0.0] * 6 + [0.001], lambda: states[-1].effort[6] == 0.001)
        observer.spin(lambda: not any(states[-1].effort), what='silence ends the control')

    def test_a_reflex_ends_the_control_until_recovery(self, observer, states, commands):
        reports = observer.listen(contract.DIAGNOSTICS)
        enable_beside(observer, commands, [0.0] * 7)
        self.send(observer, commands, [0.0] * 6 + [50.0],
                  lambda: any('aborted by reflex' in r.status[0].message for r in reports))
        refused = enable(observer)
        assert not refused.success and 'kReflex' in refused.message
        assert observer.call(Trigger, 'robot/error_recovery', Trigger.Request()).success
        enable_beside(observer, commands, [0.0] * 7)
        assert enable(observer, False).success


@pytest.mark.usefixtures('with_stand_in')
def test_a_loop_that_stands_still_while_the_arm_is_under_control_ends_it(start_node, observer):
    states = observer.listen(contract.JOINT_STATES)
    node = start_node('panda_bridge_node', hostname='here', command_timeout=1.0)
    observer.spin(lambda: states)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    enable_beside(observer, commands, [0.0] * 7)
    observer.spin_for(0.3)  # its loop has come round since, and commands are not missed yet
    node.process.send_signal(signal.SIGSTOP)
    observer.spin_for(3.0)  # twice command_timeout, and more
    node.process.send_signal(signal.SIGCONT)
    assert node.process.wait(60) == -signal.SIGALRM


@pytest.mark.usefixtures('with_stand_in')
def test_an_arm_that_a_hand_has_moved_away_is_not_taken_under_control(start_node, observer):
    """An enabled controller goes on; its torques are near zero wherever the arm stands, since none are applied."""
    states = observer.listen(contract.JOINT_STATES)
    start_node('panda_bridge_node', hostname='far', command_timeout=1.0)
    observer.spin(lambda: states)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    with pytest.raises(AssertionError, match=r'panda_joint4 is 0\.50 rad off the reference'):
        enable_beside(observer, commands, [0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0])


@pytest.mark.usefixtures('with_stand_in')
def test_the_time_that_an_arm_takes_to_begin_is_no_silence(start_node, observer):
    states, reports = observer.listen(contract.JOINT_STATES), observer.listen(contract.DIAGNOSTICS)
    node = start_node('panda_bridge_node', hostname='slow', command_timeout=1.0)
    observer.spin(lambda: states)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    enable_beside(observer, commands, [0.0] * 7)

    def answered():
        commands.publish(Float64MultiArray(data=[0.0] * 7))
        return any(value.key == 'enabled' and value.value == 'True'
                   for report in reports for value in report.status[0].values)

    observer.spin(lambda: answered() or 's: disabled, the arm' in node.log())
    assert 's: disabled, the arm' not in node.log()


def enabled_bridge(start_node, observer, hostname):
    """A bridge that has just taken an arm under control."""
    states = observer.listen(contract.JOINT_STATES)
    node = start_node('panda_bridge_node', hostname=hostname, command_timeout=1.0)
    observer.spin(lambda: states)
    enable_beside(observer, observer.publisher(contract.EFFORT_COMMANDS), [0.0] * 7)
    return node


@pytest.mark.usefixtures('with_stand_in')
@pytest.mark.parametrize('by', ['a person', 'silence', 'a signal'])
def test_a_control_that_does_not_end_ends_with_the_process(start_node, observer, by):
    node = enabled_bridge(start_node, observer, 'unstoppable')
    if by == 'a person':
        response = enable(observer, False)
        assert not response.success and 'not disabled: the control did not end (libfranka: stop f' in response.message
    elif by == 'a signal':
        node.process.send_signal(signal.SIGINT)
    assert node.process.wait(60) == 2
    assert 'error: the control did not end (libfranka: stop failed): it ends with this process, now' in node.log()
    assert 'Traceback' not in node.log() and 'the arm holds itself' not in node.log()


@pytest.mark.usefixtures('with_stand_in')
def test_an_arm_that_is_lost_is_named(start_node, observer):
    node = enabled_bridge(start_node, observer, 'lost')
    assert node.process.wait(60) == 2
    assert 'error: the arm does not answer any more: libfranka: UDP receive: Timeout' in node.log()
    assert 'Traceback' not in node.log()


@pytest.mark.usefixtures('with_stand_in')
def test_an_arm_whose_time_stands_still_is_disabled_and_services_are_served(start_node, observer):
    node = enabled_bridge(start_node, observer, 'frozen')
    reports = observer.listen(contract.DIAGNOSTICS)
    node.wait_for_log("the arm's time stands still: no new state for 1.0 s; disabled")
    assert enable(observer, False).success
    refused = enable(observer)
    assert not refused.success and "not enabled: the arm's time stands still" in refused.message
    reports.clear()
    observer.spin(lambda: len(reports) > 2)
    assert all("robot: the arm's time stands still" in r.status[0].message for r in reports)
    assert node.log().count('stands still: ') == 1 and 'stamps set anew' not in node.log()
    assert node.stop() == 0
