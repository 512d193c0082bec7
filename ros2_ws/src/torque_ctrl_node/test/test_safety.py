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

"""What holds across the controller's end, and what it does when it leaves."""

import os
import signal
import tempfile
import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from sensor_msgs.msg import JointState
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger
from torque_ctrl_node import stop_record
from torque_ctrl_node.stop_record import StopRecord


class Robot:
    """A robot that goes on by itself: a state a millisecond, whoever answers."""

    def __init__(self, observer):
        self.observer = observer
        self.commands = observer.listen(contract.EFFORT_COMMANDS)
        self.states = observer.publisher(contract.JOINT_STATES)
        self.now_ns = time.time_ns()
        self.message = JointState(
            name=list(panda().joints), position=panda().home.tolist(), velocity=[0.0] * 7, effort=[0.0] * 7)

    def run(self, ticks=300, off=0.0, velocity=0.0):
        """The torques that answer some ticks at one posture."""
        self.message.position = (panda().home + off).tolist()
        self.message.velocity = [velocity] * 7
        count = len(self.commands)
        for _ in range(ticks):
            self.tick()
        self.observer.spin_for(0.1)
        return [np.array(command.data) for command in self.commands[count:]]

    def tick(self):
        self.now_ns += 1_000_000
        set_ns(self.message.header.stamp, self.now_ns)
        self.states.publish(self.message)
        time.sleep(0.001)

    def run_until_answered(self, **posture):
        for _ in range(100):
            if self.run(50, **posture):
                return
        pytest.fail('no torque comes')

    def run_until_silent(self):
        for _ in range(100):
            if not self.run(100):
                return
        pytest.fail('torques do not end')

    def run_until_refused(self, node):
        """Far from the reference; also the sign that the controller hears the robot."""
        def run():
            assert self.run(off=0.5) == []

        node.wait_for_log('not enabled yet: panda_joint1 is 0.50 rad off the reference', beside=run)

    def ask(self, name, kind=Trigger, **request):
        return self.observer.call(kind, name, kind.Request(**request), beside=self.tick)


@pytest.fixture
def robot(observer):
    return Robot(observer)


def start(start_node):
    """As a session and the launch files start it beside a simulator."""
    node = start_node('torque_ctrl_node', enabled=True)
    node.wait_for_log('ready')
    return node


@pytest.mark.parametrize('end', [signal.SIGKILL, signal.SIGTERM])
def test_an_emergency_stop_outlives_the_controller(start_node, robot, end):
    node = start(start_node)
    robot.run_until_answered()
    assert robot.ask(contract.EMERGENCY_STOP_SERVICE).success
    robot.run_until_silent()
    node.stop(end)
    node = start(start_node)
    assert 'emergency stop: /controller/reset_emergency_stop' in node.log()
    assert robot.run() == []
    refused = robot.ask(contract.ENABLE_SERVICE, SetBool, data=True)
    assert not refused.success and 'reset_emergency_stop first' in refused.message
    assert robot.ask(contract.RESET_EMERGENCY_STOP_SERVICE).success
    assert robot.run() == [], 'disabled after the stop is over'
    assert robot.ask(contract.ENABLE_SERVICE, SetBool, data=True).success
    robot.run_until_answered()
    node.stop(signal.SIGKILL)
    start(start_node)
    robot.run_until_answered()


def test_enables_itself_only_near_the_reference(start_node, robot):
    node = start(start_node)
    robot.run_until_refused(node)
    robot.run_until_answered(off=0.1)


def test_does_not_enable_itself_after_it_was_disabled(start_node, robot):
    robot.run_until_refused(start(start_node))
    assert robot.ask(contract.ENABLE_SERVICE, SetBool, data=False).success
    assert robot.run(off=0.0) == []


@pytest.mark.parametrize('compensates', [True, False])
def test_no_torques_for_a_robot_that_is_another_as_to_gravity(start_node, observer, robot, compensates):
    """The arm would rise or sink by its weight."""
    node = start_node('torque_ctrl_node', enabled=True, robot_compensates_gravity=not compensates)
    node.wait_for_log('ready')
    robot.run_until_answered()
    reports = observer.publisher(contract.DIAGNOSTICS)

    def say(compensates):
        values = [KeyValue(key='compensates_gravity', value=str(compensates))]
        reports.publish(DiagnosticArray(status=[DiagnosticStatus(values=values)]))
        robot.run(50)

    fault = f'gravity itself: start the controller with robot_compensates_gravity:={str(compensates).lower()}'
    node.wait_for_log(fault, beside=lambda: say(compensates))
    assert robot.run() == []
    refused = robot.ask(contract.ENABLE_SERVICE, SetBool, data=True)
    assert not refused.success and fault in refused.message
    observer.spin(lambda: say(not compensates) or robot.ask(contract.ENABLE_SERVICE, SetBool, data=True).success)
    robot.run_until_answered()


def start_as_on_a_robot(start_node, robot):
    """A person enables it."""
    node = start_node('torque_ctrl_node')

    def enabled():
        robot.run(50)
        return robot.ask(contract.ENABLE_SERVICE, SetBool, data=True).success

    robot.observer.spin(enabled)
    robot.run_until_answered()
    return node


def be_silent(robot, node):
    robot.observer.spin_for(1.5)


def be_unusable(robot, node):
    effort, robot.message.effort = robot.message.effort, []
    robot.run(1500)
    robot.message.effort = effort


def be_unheard(robot, node):
    os.kill(node.process.pid, signal.SIGSTOP)
    robot.run(1500, off=0.1)
    robot.run(500, off=0.5)
    os.kill(node.process.pid, signal.SIGCONT)


@pytest.mark.parametrize('doubt', [be_silent, be_unusable, be_unheard])
def test_a_robot_that_comes_back_far_from_the_reference_gets_no_torques(start_node, robot, doubt):
    """Its driver was started anew, and a hand has moved the arm; near the reference the controller goes on."""
    node = start_as_on_a_robot(start_node, robot)
    robot.observer.spin_for(1.5)
    robot.run_until_answered(off=0.1)
    doubt(robot, node)
    answers = robot.run(off=0.5)
    if doubt is not be_unheard:
        assert answers == []
    else:
        robot.run_until_silent()
    assert 'disabled: no usable joint states came for a while, and now panda_joint1 is 0.50 rad off' in node.log()
    assert robot.run(off=0.0) == [], 'until somebody enables it'


def test_a_robot_whose_time_stands_still_while_it_moves_gets_no_torques(start_node, robot):
    node = start_as_on_a_robot(start_node, robot)
    robot.run_until_answered()
    count = len(robot.commands)
    for step in range(50):
        robot.now_ns -= 1_000_000
        robot.run(1, off=0.001 * (step % 7 + 1))
    assert len(robot.commands) == count
    assert 'its stamp is that of the one before, but the joints have moved' in node.log()


def test_a_robot_that_comes_back_after_it_was_disabled_gets_no_rest_of_the_damping(start_node, robot):
    start_as_on_a_robot(start_node, robot)
    assert robot.ask(contract.ENABLE_SERVICE, SetBool, data=False).success
    robot.observer.spin_for(1.5)
    assert robot.run() == []


def test_a_controller_that_leaves_brings_the_arm_to_rest(start_node, robot):
    node = start(start_node)
    robot.run_until_answered()
    robot.message.velocity = [0.5] * 7
    node.process.send_signal(signal.SIGTERM)
    count = len(robot.commands)
    while node.process.poll() is None:
        robot.tick()
    robot.observer.spin_for(0.1)
    last = [np.array(command.data) for command in robot.commands[count:]][-100:]
    assert len(last) == 100 and node.process.returncode == 0
    assert all(torque[0] < 0.0 for torque in last), 'against the motion; the first joint carries no weight'


def test_an_emergency_stop_while_it_leaves_is_kept(start_node, robot):
    node = start(start_node)
    robot.run_until_answered()
    stop = robot.observer.publisher(contract.EMERGENCY_STOP)
    robot.observer.spin(lambda: stop.get_subscription_count() == 2, what='the controller hears it')
    robot.message.velocity = [0.5] * 7
    node.process.send_signal(signal.SIGTERM)
    for _ in range(150):
        robot.tick()
    stop.publish(Bool(data=True))
    while node.process.poll() is None:
        robot.tick()
    robot.message.velocity = [0.0] * 7
    node = start(start_node)
    assert 'emergency stop: /controller/reset_emergency_stop' in node.log()
    robot.run_until_silent()


def test_an_emergency_stop_without_a_home_is_found_from_any_shell(tmp_path, monkeypatch):
    (tmp_path / 'home').write_text('a file')
    (tmp_path / 'shell').mkdir()
    monkeypatch.setenv('ROS_HOME', str(tmp_path / 'home'))
    monkeypatch.setattr(stop_record, 'PLACES', (str(tmp_path / 'place'),))
    StopRecord(3, '/').keep()
    monkeypatch.setenv('TMPDIR', str(tmp_path / 'shell'))
    monkeypatch.setattr(tempfile, 'tempdir', None)
    assert StopRecord(3, '/').is_on()


class TestStopRecord:
    """The record itself, with the starter as the test says."""

    @pytest.fixture(autouse=True)
    def folders(self, tmp_path, monkeypatch):
        monkeypatch.setattr(stop_record, '_folders', lambda: [tmp_path / 'home', tmp_path / 'temporary'])
        self.starter = 'session 1'
        monkeypatch.setattr(stop_record, 'starter', lambda: self.starter)
        self.path = tmp_path

    def test_is_off_at_first_and_when_forgotten(self):
        record = StopRecord(3, '/')
        assert not record.is_on()
        record.keep()
        assert record.is_on()
        record.forget()
        assert not record.is_on() and not list(self.path.rglob('*.json'))

    def test_belongs_to_one_graph(self):
        StopRecord(3, '/arm').keep()
        assert StopRecord(3, '/arm').is_on()
        assert not StopRecord(3, '/').is_on() and not StopRecord(4, '/arm').is_on()

    def test_after_a_crash_it_holds_whoever_starts_the_controller(self):
        StopRecord(3, '/').keep()
        self.starter = 'session 2'
        assert StopRecord(3, '/').is_on()

    def test_after_a_clean_end_it_holds_for_the_same_starter_alone(self):
        StopRecord(3, '/').keep()
        StopRecord(3, '/').leave()
        assert StopRecord(3, '/').is_on()
        self.starter = 'session 2'
        assert not StopRecord(3, '/').is_on()

    def test_goes_elsewhere_where_home_cannot_be_written(self):
        (self.path / 'home').write_text('a file')
        StopRecord(3, '/').keep()
        assert StopRecord(3, '/').is_on() and list(self.path.glob('temporary/*'))

    def test_the_loop_waits_for_no_disk(self, monkeypatch):
        monkeypatch.setattr(os, 'fsync', lambda _: pytest.fail('it waits'))
        StopRecord(3, '/').keep()
        assert StopRecord(3, '/').is_on()

    @pytest.mark.skipif(os.getuid() != 0, reason='root alone can become another user')
    def test_a_folder_that_may_not_be_entered_holds_no_stop(self):
        (self.path / 'home').mkdir(mode=0o700)
        self.path.chmod(0o755)
        os.seteuid(65534)
        try:
            assert not StopRecord(3, '/').is_on()
        finally:
            os.seteuid(0)

    def test_a_damaged_record_is_one_of_a_stop(self):
        StopRecord(3, '/').keep()
        next(self.path.rglob('*.json')).write_text('{')
        assert StopRecord(3, '/').is_on()
