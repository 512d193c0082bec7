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

"""Values in a parameter file that no node can run with."""

from pathlib import Path

import pytest
import yaml
from shared_control_bringup.parameter_check import check_values, refuse_overridden
from shared_control_bringup.parameters import DEFAULTS, read

PATH = Path('mine.yaml')


def check(**nodes):
    check_values(nodes, PATH)


@pytest.mark.parametrize(('node', 'values', 'said'), [
    ('torque_ctrl_node', 'command_timeout: 1', "'command_timeout' of torque_ctrl_node must be of type float.* 1.0"),
    ('torque_ctrl_node', 'moment_limit: 10', 'must be of type float'),
    ('torque_ctrl_node', 'command_timeout: 5.0', 'must be at least 0.02 and at most 1.0, not 5.0'),
    ('torque_ctrl_node', 'command_timeout: .nan', 'must be at least'),
    ('torque_ctrl_node', 'comand_timeout: 0.1', "torque_ctrl_node has no parameter 'comand_timeout'; .*command_t"),
    ('torque_ctrl_node', 'wait_for: human', 'must be of type list'),
    ('torque_ctrl_node', 'wait_for: [nobody]', "has no choice 'nobody'; there are none, human, agent"),
    ('panda_sim_node', 'seed:', 'has no value'),
    ('panda_sim_node', 'paced: 1', 'must be of type bool'),
    ('panda_sim_node', 'mode: quick', "has no choice 'quick'"),
    ('ppo_agent_node', 'test_episodes: true', 'must be of type int'),
    ('ppo_agent_node', 'test_episodes: 2.0', 'must be of type int'),
    ('ppo_agent_node', 'episode_seconds: 20', 'must be of type float'),
    ('teach_page_node', 'token: 1234', 'must be of type str'),
    ('teleop_key_node', 'joy_scale: [1, 1]', 'must be a list of float, and 1 is none'),
    ('teleop_key_node', 'failure_button: 64', 'at most 63'),
    ('panda_sim_node', 'robot: mine.yaml', r'must be the whole path of its file: write /.*/mine\.yaml'),
    ('/**', 'robot: ../mine.yaml', 'must be the whole path'),
    ('panda_sim_node', 'robot: /nowhere/mine.yaml', 'cannot be used: .*/nowhere/mine.yaml'),
    ('panda_sim_node', 'robot: pandda', 'cannot be used: .*pandda'),
    ('/**', 'seeds: 1', "no parameter 'seeds'"),
    ('/**', 'command_timeout: 1', 'must be of type float'),
])
def test_values_that_a_node_cannot_run_with_are_refused_by_name(node, values, said):
    with pytest.raises(ValueError, match=said) as error:
        check(**{node: yaml.safe_load(values)})
    assert str(error.value).startswith('mine.yaml: ')


@pytest.mark.parametrize(('node', 'values'), [
    ('torque_ctrl_node', {'command_timeout': 0.2, 'wait_for': ['human'], 'use_sim_time': True}),
    ('torque_ctrl_node', {'command_timeout': '1e-1', 'qos_overrides': {'/clock': {}}, 'qos_overrides./clock.depth': 1}),
    ('teleop_key_node', {'screen': False, 'success_button': 7, 'device': 'keys', 'joy_axes': [1, 0]}),
    ('/**', {'robot': 'panda', 'use_sim_time': False}),
    ('panda_bridge_node', {}),
])
def test_other_values_are_taken(node, values):
    check(**{node: values})


def test_our_own_file_is_taken():
    check_values(read(DEFAULTS.read_bytes(), DEFAULTS), DEFAULTS)


def test_what_a_session_decides_otherwise_is_refused_by_name():
    taken = {'torque_ctrl_node': {'moment_limit': 20.0, 'enabled': True}, 'ppo_agent_node': {'seed': 3, 'episodes': 0}}
    for given, said in (
            ({'torque_ctrl_node': {'moment_limit': 5.0}}, "'moment_limit' of torque_ctrl_node is 5.0, but .* 20.0"),
            ({'torque_ctrl_node': {'enabled': False}}, "'enabled' of torque_ctrl_node is False"),
            ({'/**': {'seed': 7}}, "'seed' of ppo_agent_node is 7, but a session gives it 3")):
        with pytest.raises(ValueError, match=said):
            refuse_overridden(given, taken, PATH)
    refuse_overridden({'ppo_agent_node': {'seed': 3, 'test_episodes': 9}}, taken, PATH)
    refuse_overridden(read(DEFAULTS.read_bytes(), DEFAULTS), {'panda_sim_node': {'seed': 5}}, PATH)
