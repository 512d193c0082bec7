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

"""What a session says that it waits for."""

import os
import signal
import sys
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from shared_control_bringup import parameters
from shared_control_bringup import waits as waits_module
from shared_control_bringup.node_process import NodeProcess
from shared_control_bringup.waits import LONGEST, Seen, Waits, wait_of
from shared_control_ros import contract
from std_msgs.msg import String

LONG = 1000.0


@pytest.mark.parametrize(('seen', 'what'), [
    (Seen(starting=('torque_ctrl_node',), phase='teach'), 'torque_ctrl_node to start'),
    (Seen(phase_age=LONG), 'ppo_agent_node to begin'),
    (Seen(phase='wait', phase_age=LONG, tick_age=LONG), 'an episode to begin'),
    (Seen(phase='teach', tick_age=LONG), 'a tick of the simulation'),
    (Seen(phase='practice', tick_age=LONG), 'a tick of the simulation'),
    (Seen(phase='teach', tick_age=LONG, paused=True), 'a person: it is paused'),
    (Seen(phase='learn', phase_age=LONG, tick_age=LONG), 'the robot to learn from the episode'),
    (Seen(phase='test', episode_age=LONG), 'an episode to come to its end'),
    (Seen(phase='teach', standing_still=(('teleop_key_node', 'a debugger holds it'),)),
     'teleop_key_node, whose loop stands still (a debugger holds it), to go on')])
def test_what_takes_too_long_is_named(seen, what):
    assert wait_of(seen).what == what


@pytest.mark.parametrize('seen', [
    Seen(), Seen(phase='teach', phase_age=LONG), Seen(phase='learn', phase_age=LONGEST['learn'] / 2, tick_age=LONG),
    Seen(phase='done', phase_age=LONG, tick_age=LONG, episode_age=LONG), Seen(phase='practice', episode_age=LONG)])
def test_what_goes_on_is_no_wait(seen):
    assert wait_of(seen) is None


def test_a_simulator_that_waits_is_said_with_its_warning_and_a_stopped_controller_first(domain_id, observer, tmp_path):
    file = tmp_path / 'parameters.yaml'
    parameters.save(parameters.load(), file)
    simulator = NodeProcess('panda_sim_node', file, tmp_path / 'panda_sim_node.log')
    said = []
    published = observer.listen(contract.WAITING)
    waits = Waits([simulator], said.append)
    phase = observer.node.create_publisher(String, contract.PHASE.name, contract.PHASE.qos)
    reports = observer.publisher(contract.DIAGNOSTICS)
    simulator.start()
    waits.open()
    try:
        phase.publish(String(data='teach'))
        deadline = time.monotonic() + 60.0
        while not any('no torque on' in message.data for message in published):
            assert time.monotonic() < deadline, said
            waits.poll()
            observer.spin_for(0.1)
        what, why = published[-1].data.split('\n')
        assert what.startswith('for a tick of the simulation since ')
        assert why.startswith('panda_sim_node: no torque on /effort_controller/commands')
        assert any(line.startswith('waiting for a tick of the simulation since') for line in said)
        for status in (DiagnosticStatus(level=DiagnosticStatus.ERROR, message='emergency stop: reset it'),
                       DiagnosticStatus(level=DiagnosticStatus.WARN, message='disabled: enable it',
                                        values=[KeyValue(key='enabled', value='False')])):
            status.name = '/torque_ctrl_node'
            while not published[-1].data.endswith(f'\ntorque_ctrl_node: {status.message}'):
                assert time.monotonic() < deadline, said
                reports.publish(DiagnosticArray(status=[status]))
                waits.poll()
                observer.spin_for(0.1)
        phase.publish(String(data='done'))
        while published[-1].data:
            assert time.monotonic() < deadline, said
            waits.poll()
            observer.spin_for(0.1)
    finally:
        waits.close()
        simulator.interrupt()
        simulator.wait(60)


FREEZES = """
import sys, time
from pathlib import Path
from rclpy.node import Node
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.runner import run

class Freezes:
    def __init__(self):
        self.node = Node('sim_tutor_node')
        self._diagnostics = Diagnostics(self.node, 0.02)

    def run(self, stop):
        while True:
            time.sleep(0.1)
            if self._diagnostics.due():
                self._diagnostics.publish({})
            if Path(sys.argv[1]).exists():
                never_again()

    def close(self):
        pass

def never_again():
    time.sleep(3600)

run(Freezes, [])
"""


@pytest.fixture
def watched(domain_id, observer, tmp_path, monkeypatch):
    """A node that stands still when it is told to, what waits for it said, and what was reported of it."""
    monkeypatch.setattr(waits_module, 'STANDSTILL', 3.0)
    monkeypatch.setattr(waits_module, 'ENDED_AFTER', 6.0)
    (tmp_path / 'log').mkdir()
    node = NodeProcess('sim_tutor_node', tmp_path / 'none.yaml', tmp_path / 'log' / 'sim_tutor_node.log')
    freeze = tmp_path / 'freeze'
    node._command = [sys.executable, '-c', FREEZES, str(freeze)]
    said, reports = [], observer.listen(contract.DIAGNOSTICS)
    waits = Waits([node], said.append)
    node.start()
    waits.open()

    def until(condition):
        deadline = time.monotonic() + 60.0
        while not condition():
            assert time.monotonic() < deadline, said
            waits.poll()
            observer.spin_for(0.05)

    def of(name):
        return [report.status[0] for report in reports if report.status[0].name == name]

    until(lambda: of('/sim_tutor_node'))
    yield node, said, until, of, freeze, waits
    waits.close()
    node.kill()
    node.wait(60)


def test_a_loop_that_somebody_has_stopped_is_said_and_reported_and_left_alone(watched, monkeypatch):
    node, said, until, of, *_, waits = watched
    now = time.monotonic
    waits.poll()
    monkeypatch.setattr(waits_module.time, 'monotonic', lambda: now() + 100.0)  # as after Ctrl-Z and fg
    waits.poll()
    assert not said and '<module>' not in node.log.read_text(), 'it was this process that stood still'
    os.kill(node.pid, signal.SIGSTOP)
    began = time.monotonic()
    until(lambda: time.monotonic() > began + 9.0 and of('/session'))
    assert of('/session')[-1].level == DiagnosticStatus.ERROR
    assert 'sim_tutor_node, whose loop stands still (somebody has stopped it' in of('/session')[-1].message
    assert any('somebody has stopped it' in line for line in said)
    os.kill(node.pid, signal.SIGCONT)
    until(lambda: of('/session')[-1].level == DiagnosticStatus.OK)
    assert '<module>' in node.log.read_text(), 'where it stood'
    assert node.exit_code() is None


def test_a_loop_that_stands_still_by_itself_writes_where_and_is_ended(watched):
    node, said, until, of, freeze, _ = watched
    freeze.touch()
    until(lambda: node.exit_code() is not None and of('/session'))
    assert node.exit_code() == -signal.SIGKILL
    assert 'in never_again' in node.log.read_text()
    assert any('has stood still for' in line and 'log/sim_tutor_node.log' in line for line in said)
    assert 'log/sim_tutor_node.log' in of('/session')[0].message, 'recorded, hence without the path of the folder'
    assert str(node.log) not in of('/session')[0].message


def test_the_newest_warning_of_a_node_is_found_in_its_log(tmp_path):
    node = NodeProcess('torque_ctrl_node', tmp_path / 'none.yaml', tmp_path / 'log')
    assert node.newest_warning() is None
    ticks = 1000 * '[INFO] [8.0] [torque_ctrl_node]: tick\n'
    node.log.write_text(f'[WARN] [7.5] [torque_ctrl_node]: too late\n{ticks}')
    assert node.newest_warning() is None, 'long ago'
    with node.log.open('a') as log:
        log.write('[WARN] [9.5] [torque_ctrl_node]: no wrench\n[ERROR] [10.5] [torque_ctrl_node]: stopped\n'
                  '[INFO] [11.0] [torque_ctrl_node]: ready\n')
    assert node.newest_warning() == (10.5, 'stopped')
