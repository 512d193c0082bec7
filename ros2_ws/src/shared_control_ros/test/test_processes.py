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

"""The environment that nodes are started in, and how they leave."""

import signal
import subprocess
import sys

import pytest
from shared_control_ros.processes import node_environment


@pytest.fixture
def another_install(tmp_path):
    """Folders as another install of ROS has them, and one of the user's own."""
    (tmp_path / 'py' / 'rclpy').mkdir(parents=True)
    (tmp_path / 'py' / 'rclpy' / '__init__.py').write_text('raise ImportError("made for another Python")')
    (tmp_path / 'lib').mkdir()
    (tmp_path / 'lib' / 'librmw_fastrtps_cpp.so').touch()
    (tmp_path / 'mine').mkdir()
    (tmp_path / 'mine' / 'my_module.py').write_text('VALUE = 7')
    return tmp_path


def test_what_belongs_to_another_install_is_left_out(another_install, monkeypatch):
    monkeypatch.setenv('PYTHONPATH', f'{another_install / "py"}:{another_install / "mine"}')
    monkeypatch.setenv('LD_LIBRARY_PATH', f'{another_install / "lib"}:{another_install / "mine"}')
    monkeypatch.setenv('RMW_IMPLEMENTATION', 'rmw_of_somebody_cpp')
    environment = node_environment()
    assert environment['PYTHONPATH'] == environment['LD_LIBRARY_PATH'] == str(another_install / 'mine')
    code = 'import my_module, rclpy; rclpy.init(); rclpy.create_node("a")'
    assert subprocess.run([sys.executable, '-c', code], env=environment, check=False).returncode == 0


def test_nothing_is_imported_from_where_somebody_happens_to_be(tmp_path):
    (tmp_path / 'queue.py').write_text('raise SystemExit("the wrong queue")')
    (tmp_path / 'shared_control').mkdir()
    code = [sys.executable, '-c', 'import torque_ctrl_node.node']
    assert subprocess.run(code, env=node_environment(), cwd=tmp_path, check=False, timeout=60).returncode == 0


def test_the_graph_stays_on_this_machine_unless_somebody_decides(monkeypatch):
    for variable in ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE'):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv('ROS_DISCOVERY_SERVER', '10.0.0.1:11811')
    monkeypatch.setenv('ROS_LOCALHOST_ONLY', '1')
    assert not {'ROS_DISCOVERY_SERVER', 'ROS_LOCALHOST_ONLY'} & node_environment().keys()
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    assert node_environment()['ROS_DISCOVERY_SERVER'] == '10.0.0.1:11811'


@pytest.mark.parametrize('variables', [{}, {'HOME': '/proc/nowhere'}, {'ROS_LOG_DIR': '/proc/nowhere'}])
def test_a_node_runs_where_no_log_can_be_written(domain_id, variables):
    environment = {name: value for name, value in node_environment().items()
                   if name not in ('HOME', 'ROS_HOME', 'ROS_LOG_DIR')}
    node = subprocess.Popen([sys.executable, '-m', 'teleop_key_node.node'], env={**environment, **variables},
                            stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
    try:
        said = [node.stderr.readline()]
        while 'ready' not in said[-1]:
            assert said[-1], f'it ended: {said}'
            said.append(node.stderr.readline())
    finally:
        node.terminate()
        node.communicate(timeout=60)
    assert any('ROS_LOG_DIR' in line for line in said)


HELD_UP = """
import sys, time
import rclpy
from shared_control_ros import runner

class Visitor:
    def __init__(self):
        self.node = rclpy.create_node('visitor')
        if sys.argv[1] == 'held up':
            self.node.destroy_node = lambda: time.sleep(100)
    def run(self, stop):
        pass
    def close(self):
        print('closed', flush=True)

runner.LEAVE_SECONDS = 1.0
sys.exit(runner.run(Visitor))
"""


@pytest.mark.parametrize(('how', 'code'), [('freely', 0), ('held up', -signal.SIGALRM)])
def test_a_node_that_is_held_up_when_it_leaves_is_ended(domain_id, how, code):
    ended = subprocess.run([sys.executable, '-c', HELD_UP, how], timeout=60, capture_output=True, text=True)
    assert ended.returncode == code, ended.stderr
    assert 'closed' in ended.stdout
