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

"""A second robot, controller or learner is refused by name."""

import os
import signal
import tempfile
from pathlib import Path

import pytest
from rclpy.context import Context
from rclpy.node import Node
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import ParameterError


@pytest.mark.parametrize(('first', 'second', 'role'), [
    ('torque_ctrl_node', 'torque_ctrl_node', 'controller'), ('panda_sim_node', 'mock_panda_node', 'robot'),
    ('ppo_agent_node', 'ppo_agent_node', 'learner')])
def test_a_second_one_is_refused_and_what_was_killed_is_no_hindrance(start_node, first, second, role):
    there = start_node(first)
    there.wait_for_log('ready')
    refused = start_node(second)
    assert refused.process.wait(60) == 2
    assert f'/{first} (process {there.process.pid}) is the {role} in ROS domain' in refused.log()
    assert 'ROS_DOMAIN_ID' in refused.log() and 'Traceback' not in refused.log()
    there.stop(signal.SIGKILL)
    start_node(second).wait_for_log('ready')


@pytest.fixture
def node(domain_id):
    context = Context()
    context.init(domain_id=domain_id)
    node = Node('claims', context=context)
    yield node
    node.destroy_node()
    context.shutdown()


@pytest.fixture
def everybodys_folder(monkeypatch):
    """For temporary files; pytest's own is its user's alone."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        monkeypatch.setattr(tempfile, 'tempdir', folder)
        yield Path(folder)


@pytest.mark.skipif(os.getuid() != 0, reason='root alone can become another user')
def test_another_user_is_no_hindrance_but_where_the_file_cannot_be_read(node, everybodys_folder):
    before = os.umask(0o077)
    claim(node, 'robot').close()
    os.umask(before)
    (file,) = everybodys_folder.iterdir()
    os.seteuid(65534)
    try:
        claim(node, 'robot').close()
    finally:
        os.seteuid(0)
    file.chmod(0o600)
    os.seteuid(65534)
    try:
        with pytest.raises(ParameterError, match=f'{file} is of another user'):
            claim(node, 'robot')
    finally:
        os.seteuid(0)
