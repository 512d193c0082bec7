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

"""A second robot, controller, teleoperation or learner is refused by name."""

import os
import re
import signal
import tempfile

import pytest
from rclpy.context import Context
from rclpy.node import Node
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import ParameterError


@pytest.mark.parametrize(('first', 'second', 'role'), [
    ('torque_ctrl_node', 'torque_ctrl_node', 'controller'), ('panda_sim_node', 'mock_panda_node', 'robot'),
    ('ppo_agent_node', 'ppo_agent_node', 'learner'), ('teleop_key_node', 'teleop_key_node', 'teleoperation')])
def test_a_second_one_is_refused_and_what_was_killed_is_no_hindrance(start_node, first, second, role):
    there = start_node(first)
    there.wait_for_log('ready')
    refused = start_node(second)
    assert refused.process.wait(60) == 2
    named = re.compile(rf'process {there.process.pid} \(\S+ .*{first}\S*\) is the {role} in ROS domain')
    assert named.search(refused.log()), refused.log()
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


def test_a_role_is_one_in_all_shells(node, monkeypatch, tmp_path):
    with claim(node, 'robot'):
        monkeypatch.setenv('TMPDIR', str(tmp_path))
        monkeypatch.setattr(tempfile, 'tempdir', None)
        with pytest.raises(ParameterError, match=rf'process {os.getpid()} \(.+\) is the robot in ROS domain'):
            claim(node, 'robot')
        claim(node, 'controller').close()
    claim(node, 'robot').close()


def test_all_who_ask_are_refused_however_many(node):
    with claim(node, 'robot'):
        for _ in range(300):
            with pytest.raises(ParameterError, match='is the robot in ROS domain'):
                claim(node, 'robot')


@pytest.mark.skipif(os.getuid() != 0, reason='root alone can become another user')
def test_a_role_is_one_for_all_users(node):
    with claim(node, 'robot'):
        os.seteuid(65534)
        try:
            with pytest.raises(ParameterError, match='is the robot in ROS domain'):
                claim(node, 'robot')
            claim(node, 'learner').close()
        finally:
            os.seteuid(0)
    claim(node, 'learner').close()
