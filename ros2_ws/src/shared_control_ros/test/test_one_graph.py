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

"""A second robot or controller is refused by name."""

import signal

import pytest


@pytest.mark.parametrize(('first', 'second', 'role'), [
    ('torque_ctrl_node', 'torque_ctrl_node', 'controller'), ('panda_sim_node', 'mock_panda_node', 'robot')])
def test_a_second_one_is_refused_and_what_was_killed_is_no_hindrance(start_node, first, second, role):
    there = start_node(first)
    there.wait_for_log('ready')
    refused = start_node(second)
    assert refused.process.wait(60) == 2
    assert f'/{first} (process {there.process.pid}) is the {role} in ROS domain' in refused.log()
    assert 'ROS_DOMAIN_ID' in refused.log() and 'Traceback' not in refused.log()
    there.stop(signal.SIGKILL)
    start_node(second).wait_for_log('ready')
