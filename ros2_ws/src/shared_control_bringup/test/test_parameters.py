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

"""The parameter file of a session."""

import pytest
import yaml
from shared_control_bringup.parameters import DEFAULTS, blanked, load, save


def test_the_file_that_comes_with_the_package():
    parameters = load()
    assert parameters['panda_sim_node']['mode'] == 'lockstep'
    assert parameters['ppo_agent_node']['use_sim_time'] is True


def test_what_is_saved_can_be_loaded(tmp_path):
    save(load(), tmp_path / 'parameters.yaml')
    assert load(tmp_path / 'parameters.yaml') == load(DEFAULTS)


@pytest.mark.parametrize(('content', 'said'), [
    ('a: [', 'not valid YAML'),
    ('a: 2026-13-40', 'not valid YAML'),
    ('panda_sim_node: {ros__parameters: {seed: 1, seed: 2}}', "line 1: the key 'seed' stands there twice"),
    ('panda_sim_node: {ros__parameters: {seed: 1}}\npanda_sim_node: {ros__parameters: {}}', 'line 2: .* twice'),
    (20_000 * '[', 'nested too deeply'),
    ('- 1', 'not a ROS parameter file'),
    ('panda_sim: {ros__parameters: {mode: lockstep}}', "there is no node 'panda_sim'; there are .*panda_sim_node"),
    ('panda_sim_node: {mode: lockstep}', "'panda_sim_node' has no ros__parameters"),
])
def test_other_files_are_refused_by_name(tmp_path, content, said):
    path = tmp_path / 'mine.yaml'
    path.write_text(content)
    with pytest.raises(ValueError, match=said) as error:
        load(path)
    assert 'mine.yaml' in str(error.value)


def test_a_few_values_are_laid_over_the_defaults(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text('/**: {ros__parameters: {use_sim_time: false}}\n'
                    '/panda_sim_node: {ros__parameters: {seed: 4}}\n'
                    'mock_panda_node: {ros__parameters: {jitter: 0.0}}\n')
    parameters, defaults = load(path), load()
    assert parameters['panda_sim_node'] == {**defaults['panda_sim_node'], 'seed': 4, 'use_sim_time': False}
    assert parameters['torque_ctrl_node'] == {**defaults['torque_ctrl_node'], 'use_sim_time': False}
    assert parameters['mock_panda_node'] == {'jitter': 0.0, 'use_sim_time': False}


def test_a_file_that_is_no_text_is_refused_by_name(tmp_path):
    (tmp_path / 'mine.yaml').write_bytes(b'\xff\xfe\x00')
    with pytest.raises(ValueError, match=r'mine\.yaml is not valid YAML'):
        load(tmp_path / 'mine.yaml')


def test_a_parameter_is_blanked_and_all_else_stays_as_it_was():
    text = """# mine
/**:  {ros__parameters: {use_sim_time: false, token: secret}}   # all
/**/teach_page_node:
  ros__parameters: &page
    "token": &mine !!str "s€cret"  # of the page
    port: 8088
teleop_key_node:
  ros__parameters:
    token: *mine
    <<: *page
ppo_agent_node:
  ros__parameters:
    token: |
      secret
      secret
    # the end
    preset: token
"""
    expected = (text.replace('token: secret', "token: ''").replace('"s€cret"', "''")
                .replace('|\n      secret\n      secret\n    # the end', "''\n    # the end"))
    assert blanked(text.encode(), 'token').decode() == expected
    assert 'cret' not in str(yaml.safe_load(expected))
    assert blanked(b'# nothing\nppo_agent_node: {ros__parameters: {}}\n', 'token') == (
        b'# nothing\nppo_agent_node: {ros__parameters: {}}\n')


def test_what_all_nodes_share_is_written_without_aliases(tmp_path):
    (tmp_path / 'mine.yaml').write_text('/**: {ros__parameters: {joy_scale: [1.0, -1.0]}}\n')
    parameters = load(tmp_path / 'mine.yaml')
    save(parameters, tmp_path / 'parameters.yaml')
    assert '&' not in (tmp_path / 'parameters.yaml').read_text(), 'ROS refuses them'
    assert load(tmp_path / 'parameters.yaml') == parameters
