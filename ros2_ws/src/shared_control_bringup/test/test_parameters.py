"""The parameter file of a session."""

import pytest
from shared_control_bringup.parameters import DEFAULTS, load, save


def test_the_file_that_comes_with_the_package():
    parameters = load()
    assert parameters['panda_sim_node']['mode'] == 'lockstep'
    assert parameters['ppo_agent_node']['use_sim_time'] is True


def test_what_is_saved_can_be_loaded(tmp_path):
    save(load(), tmp_path / 'parameters.yaml')
    assert load(tmp_path / 'parameters.yaml') == load(DEFAULTS)


@pytest.mark.parametrize(('content', 'said'), [
    ('a: [', 'not valid YAML'),
    ('- 1', 'not a ROS parameter file'),
    ('panda_sim_node: {mode: lockstep}', "'panda_sim_node' has no ros__parameters"),
])
def test_other_files_are_refused_by_name(tmp_path, content, said):
    path = tmp_path / 'mine.yaml'
    path.write_text(content)
    with pytest.raises(ValueError, match=said) as error:
        load(path)
    assert 'mine.yaml' in str(error.value)
