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

"""The node alone; on the graph it is tested in tests/test_mock_panda.py."""

import shutil
import signal
import time

import pytest
from shared_control_ros import contract
from shared_control_ros.stamps import to_ns
from shared_control_testing.faults.machine import Machine
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool


@pytest.mark.parametrize('physics', ['bullet', 'mujoco'])
def test_leaves_cleanly_and_has_told_its_mode(start_node, observer, physics):
    reports = observer.listen(contract.DIAGNOSTICS)
    node = start_node('mock_panda_node', pace=0.5, physics=physics)
    observer.spin(lambda: reports)
    assert {v.key: v.value for v in reports[0].status[0].values}['mode'] == 'idle'
    assert 'held by the brakes' in reports[0].status[0].message
    assert node.stop(signal.SIGINT) == 0
    assert 'Traceback' not in node.log()


@pytest.mark.parametrize(('parameters', 'said'), [
    ({'drop_rate': 2.0}, "'drop_rate'"), ({'pace': 0.0}, "'pace'"), ({'physics': 'flat'}, 'bullet, mujoco')])
def test_wrong_parameters_are_named(start_node, parameters, said):
    node = start_node('mock_panda_node', **parameters)
    assert node.process.wait(60) == 2
    assert said in node.log() and 'Traceback' not in node.log()


def test_it_moves_only_while_it_is_enabled(start_node, observer):
    start_node('mock_panda_node', pace=0.5)
    reports = observer.listen(contract.DIAGNOSTICS)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    torques = Float64MultiArray(data=[0.0] * 7)

    def mode():
        commands.publish(torques)
        return {value.key: value.value for value in reports[-1].status[0].values}['mode'] if reports else ''

    def enable(data):
        return observer.call(SetBool, contract.ROBOT_ENABLE_SERVICE, SetBool.Request(data=data),
                             beside=lambda: commands.publish(torques))

    observer.spin(lambda: mode() == 'move')
    assert enable(False).success
    observer.spin(lambda: mode() == 'idle')
    observer.spin(lambda: mode() and 'robot/enable to go on' in reports[-1].status[0].message)
    assert enable(True).success
    observer.spin(lambda: mode() == 'move')


def test_disabled_it_holds_the_arm_at_once_whatever_its_timeout(start_node, observer):
    start_node('mock_panda_node', pace=0.1, command_timeout=10.0, drop_rate=0.0)  # the ball's weight moves the arm
    states, reports = observer.listen(contract.JOINT_STATES), observer.listen(contract.DIAGNOSTICS)
    commands = observer.publisher(contract.EFFORT_COMMANDS)
    torques = Float64MultiArray(data=[0.0] * 6 + [0.001])

    def moved():
        commands.publish(torques)
        return states and states[-1].effort[6]

    observer.spin(moved)
    assert observer.call(SetBool, contract.ROBOT_ENABLE_SERVICE, SetBool.Request(data=False)).success
    observer.spin(lambda: not states[-1].effort[6], 5.0, 'the control ends before the timeout')
    status = observer.spin(lambda: reports and 'disabled' in reports[-1].status[0].message and reports[-1].status[0])
    assert {value.key: value.value for value in status.values}['mode'] == 'idle'


@pytest.mark.skipif(shutil.which('cc') is None, reason='cc compiles what sets the clock')
def test_its_stamps_follow_a_clock_that_was_set(start_node, observer, tmp_path, monkeypatch):
    """Keys are stamped by it; after a step they were too old or too new for good."""
    machine = Machine(tmp_path)
    for name, value in machine.environment.items():
        monkeypatch.setenv(name, value)
    states = observer.listen(contract.JOINT_STATES_THROTTLE)
    node = start_node('mock_panda_node')
    observer.spin(lambda: states)
    for step in (5.0, -10.0):
        machine.set_clock(step)
        observer.spin(lambda: abs(to_ns(states[-1].header.stamp) * 1e-9 - time.time() - machine.clock_s) < 0.3)
    assert "stamps set anew: this machine's clock was set back by 10.0 s" in node.log()
    machine.close()
