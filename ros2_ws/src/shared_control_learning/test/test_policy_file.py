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

"""Policies on disk: what goes in comes out, resuming is as if nothing had happened, and rubbish is refused."""

import json

import pytest
import torch
from safetensors.torch import load, save
from shared_control.env import SharedControlEnv
from shared_control.plugins import LEARNERS, names
from shared_control_learning import corrections, learner, memory, policy_file
from shared_control_learning.learn import learn
from shared_control_learning.policy_file import PolicyFileError, load_policy, read_description, save_policy
from shared_control_learning.presets import COACHED, preset


def is_same(one, other):
    """Whether two learners have learned the same, to the bit."""
    known = other.tensors()
    return one.tensors().keys() == known.keys() and all(
        torch.equal(tensor, known[name]) for name, tensor in one.tensors().items())


@pytest.fixture
def path(tmp_path):
    return tmp_path / 'policy.safetensors'


@pytest.mark.parametrize('name', names(LEARNERS))
def test_resuming_is_as_if_nothing_had_happened(path, name, fake_plant):
    env = SharedControlEnv(fake_plant(5.0, falls_at=150), preset(name).task)
    straight = preset(name).make(7)
    learn(straight, env, episodes=3)
    first = preset(name).make(7)
    learn(first, env, episodes=2)
    save_policy(first, path)
    resumed = load_policy(path)
    assert (resumed.episode, resumed.seed, resumed.name) == (2, 7, name)
    assert (resumed.task, resumed.settings) == (preset(name).task, preset(name).settings)
    assert is_same(resumed, first)
    learn(resumed, env, episodes=3)
    assert is_same(resumed, straight)


@pytest.mark.parametrize('name', names(LEARNERS))
def test_what_is_written_can_be_read_however_much_was_learned_from(path, name, fake_plant, monkeypatch):
    for module in (learner, memory, corrections):
        monkeypatch.setattr(module, 'ROWS_MAX', 200)
    taught = preset(name).make(7)
    learn(taught, SharedControlEnv(fake_plant(5.0, falls_at=150), preset(name).task), episodes=2)
    save_policy(taught, path)
    assert is_same(load_policy(path), taught)


def test_a_file_that_would_be_too_large_to_be_read_is_not_written(path, monkeypatch):
    save_policy(COACHED.make(), path)
    before = path.read_bytes()
    monkeypatch.setattr(policy_file, 'SIZE_MAX', len(before) - 1)
    with pytest.raises(PolicyFileError, match=rf'{path} was not written: it would take {len(before)} bytes'):
        save_policy(COACHED.make(), path)
    assert path.read_bytes() == before


def test_saves_over_an_older_file_and_leaves_nothing_else(path):
    learner = COACHED.make()
    save_policy(learner, path)
    learner.episode = 4
    save_policy(learner, path)
    assert read_description(path)['episode'] == 4
    assert list(path.parent.iterdir()) == [path]


def refused(path, reason):
    with pytest.raises(PolicyFileError, match=reason) as error:
        load_policy(path)
    assert str(path) in str(error.value)


def test_missing_and_foreign_files_are_refused(path):
    refused(path, 'no policy file')
    path.write_bytes(b'')
    refused(path, 'is no policy')
    path.write_bytes(b'\x80\x04rubbish' * 100)
    refused(path, 'is no policy')
    path.write_bytes(save({'a': torch.zeros(3)}))
    refused(path, 'is no policy')
    with path.open('wb') as file:
        file.truncate(2**30)
    refused(path, '1073741824 bytes')


def test_a_truncated_file_is_refused(path):
    save_policy(COACHED.make(), path)
    content = path.read_bytes()
    for size in (4, 100, len(content) // 2, len(content) - 1):
        path.write_bytes(content[:size])
        refused(path, 'is no policy')


def change(path, description=lambda d: None, tensors=lambda t: None, name='coached'):
    """Write a good file with something changed in it."""
    save_policy(preset(name).make(), path)
    stored, words = load(path.read_bytes()), read_description(path)
    description(words)
    tensors(stored)
    path.write_bytes(save(stored, {'policy': json.dumps(words)}))


@pytest.mark.parametrize(('edit', 'reason'), [
    (lambda d: d.update(format='shared-control policy 99'), 'of this version'),
    (lambda d: d.update(preset='magic'), "no learner 'magic'"),
    (lambda d: d.update(task='magic'), "no task 'magic'"),
    (lambda d: d['settings']['ppo'].update(hidden=[100_000]), r'ppo\.hidden\.0: .*less than or equal to 1024'),
    (lambda d: d['settings']['ppo'].update(hidden=[8] * 5), r'settings\.ppo\.hidden: .*at most 4'),
    (lambda d: d['settings']['ppo'].update(value_hidden=[8, 8]), 'expected torch.float32'),
    (lambda d: d['settings']['ppo'].update(hidden='wide'), 'hidden'),
    (lambda d: d['task_settings'].update(action_scale=float('nan')), 'action_scale'),
    (lambda d: d['task_settings'].pop('action_scale'), r'task_settings\.action_scale: is missing'),
    (lambda d: d['task_settings'].update(gravity=1.0), r'task_settings\.gravity: is not known'),
    (lambda d: d.update(episode=-1), 'episode'),
    (lambda d: d.update(seed='x'), 'seed'),
    (lambda d: d.update(seed=2**32), 'seed'),
    (lambda d: d.update(author='x'), 'author: is not known'),
    (lambda d: d['action_space'].update(low=[-2.0]), 'action_space'),
    (lambda d: d.pop('preset'), 'preset'),
])
def test_a_wrong_description_is_refused(path, edit, reason):
    change(path, description=edit)
    refused(path, reason)


@pytest.mark.parametrize(('part', 'field', 'value'), [
    ('task', 'observation_scales', [0.1, 0.0, 0.1]), ('task', 'observation_scales', [0.1, 0.1]),
    ('task', 'weight_pitch', -1.0), ('task', 'fall_reward', float('-inf')), ('task', 'episode_seconds', 0.0),
    *(('task', field, value) for field in ('action_scale', 'moment_limit', 'reward_scale', 'episode_seconds')
      for value in (1e300, 1e-300)),
    ('task', 'fall_reward', 1.0), ('task', 'fall_reward', -1e300), ('task', 'fallen_below', 1e300),
    ('task', 'weight_position', 1e300), ('task', 'rate_centre', -1e300), ('task', 'position_error_max_squared', 1e-300),
    ('task', 'observation_scales', [0.1, 1e-300, 0.1]), ('ppo', 'learning_rate', 1e-300),
    ('task', 'rate_centre', 10.0), ('task', 'moment_limit', '20'),
    ('ppo', 'batch_size', 1), ('ppo', 'batch_size', True), ('ppo', 'noise_seconds', -0.1), ('ppo', 'epochs', 0),
    ('ppo', 'epochs', 1001), ('ppo', 'learning_rate', 0.0), ('ppo', 'learning_rate_min', -1.0), ('ppo', 'gamma', 1.1),
    ('ppo', 'gae_lambda', -0.1), ('ppo', 'clip_range', 0.0), ('ppo', 'initial_std', 0.0), ('ppo', 'std_min', -1.0),
    ('ppo', 'value_weight', -0.5), ('ppo', 'entropy_weight', float('nan')), ('ppo', 'std_decay', 10**400),
    ('coaching', 'delays', [-0.1]), ('coaching', 'delays', [5.1]), ('coaching', 'delays', [0.1] * 101),
    ('coaching', 'delays', []), ('coaching', 'memory_episodes', -1), ('coaching', 'memory_episodes', 1001),
    ('coaching', 'weight', -1.0), ('coaching', 'fade_episodes', 0), ('coaching', 'gain', None),
])
def test_settings_out_of_range_are_refused_by_name(path, part, field, value):
    def part_of(words, part):
        return words['task_settings'] if part == 'task' else words['settings'][part]

    change(path, description=lambda d: part_of(d, part).update({field: value}))
    refused(path, rf'\b{field}\b')


@pytest.mark.parametrize('field', ['error', 'velocity', 'moment'])
def test_a_regulator_of_settings_that_overflow_is_refused(path, field):
    change(path, description=lambda d: d['settings'].update({field: 1e-300}), name='lqr')
    refused(path, rf'settings\.{field}')


@pytest.mark.parametrize('edit', [
    lambda t: t.update({'\x1b[31mred': torch.zeros(1)}),
    lambda t: t.update({'\x1b[31mred': torch.full((1,), float('nan'))}),
    lambda t: t.update({f'\x1b[31mred{number}': torch.zeros(1) for number in range(1000)})])
def test_names_of_tensors_are_told_short_and_harmless(path, edit):
    change(path, tensors=edit)
    with pytest.raises(PolicyFileError, match=r'\\x1b\[31mred') as error:
        load_policy(path)
    assert '\x1b' not in str(error.value) and len(str(error.value)) < 1000


@pytest.mark.parametrize(('edit', 'reason'), [
    (lambda t: t['policy.log_std'].fill_(float('nan')), 'policy.log_std has numbers that are not finite'),
    (lambda t: t.pop('policy.log_std'), 'differ: policy.log_std'),
    (lambda t: t.update(extra=torch.zeros(1)), 'differ: extra'),
    (lambda t: t.update({'policy.log_std': torch.zeros(2)}), r'policy.log_std is torch.float32 \(2,\)'),
    (lambda t: t.update({'policy.log_std': torch.zeros(1, dtype=torch.float64)}), 'float64'),
    *((lambda t, kind=kind: t.update({'policy.log_std': torch.zeros(1, dtype=kind)}), str(kind)) for kind in (
        torch.float8_e4m3fn, torch.float8_e5m2, torch.bfloat16, torch.uint16)),
    (lambda t: t.update({name: torch.zeros(100_001, *tensor.shape[1:])
                         for name, tensor in t.items() if name.startswith('corrections.')}),
     r'corrections\.episodes, .* have 100001 rows, at most 100000'),
])
def test_wrong_tensors_are_refused(path, edit, reason):
    change(path, tensors=edit)
    refused(path, reason)
