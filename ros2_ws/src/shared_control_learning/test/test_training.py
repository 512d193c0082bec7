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

"""Teaching in process: what is kept, and that a run goes on as if it had never stopped."""

import json
import shlex
from dataclasses import replace

import pytest
import torch
from shared_control.cli import main
from shared_control.run_folder import RunFolder
from shared_control.teaching.profiles import profile
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode_table import read_rows
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.presets import preset, preset_for
from shared_control_learning.training import TrainingError, TrainingRun, read_run, train

SHORT = replace(preset('coached'), task=replace(preset('coached').task, episode_seconds=2.0))
EXPERT = profile('expert')


class Killed(Exception):
    """Stands for the end of the process."""


class KillIn(Callbacks):
    """Ends the run in the middle of an episode."""

    def __init__(self, episode):
        self._episode = episode

    def stepped(self, episode):
        if episode.number == self._episode and len(episode) == 40:
            raise Killed


def test_a_run_that_was_killed_ends_as_one_that_was_not(tmp_path):
    train(SHORT, EXPERT, 5, 3, folder=tmp_path / 'whole', evaluate_every=0)
    for episode in (2, 3):
        with pytest.raises(Killed):
            train(SHORT, EXPERT, 5, 3, folder=tmp_path / 'parts', evaluate_every=0, callbacks=KillIn(episode))
    run = train(SHORT, EXPERT, 5, 3, folder=tmp_path / 'parts', evaluate_every=0, tensorboard=True)
    whole, parts = ((tmp_path / name / 'policy.safetensors').read_bytes() for name in ('whole', 'parts'))
    assert whole == parts
    assert run.returns == read_run(tmp_path / 'whole').returns
    assert [row['episode'] for row in read_rows(tmp_path / 'parts/episodes.csv')] == ['1', '2', '3']
    assert list((tmp_path / 'parts/tensorboard').iterdir())


def test_a_seed_gives_the_same_policy_whatever_the_number_of_threads(tmp_path):
    for threads in (2, 1):
        torch.set_num_threads(threads)
        train(preset('coached'), profile('expert'), 0, 1, evaluate_every=0, folder=tmp_path / str(threads))
        assert torch.get_num_threads() == threads
    one, two = (load_policy(tmp_path / name / POLICY_NAME).policy.state_dict() for name in ('1', '2'))
    assert all(torch.equal(one[name], two[name]) for name in one)


def test_another_run_is_not_mixed_in(tmp_path):
    train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0)
    with pytest.raises(TrainingError, match='seed 5, asked for 6'):
        train(SHORT, None, 6, 2, folder=tmp_path, evaluate_every=0)
    with pytest.raises(TrainingError, match="physics 'bullet', asked for 'mujoco'"):
        train(SHORT, None, 5, 2, folder=tmp_path, evaluate_every=0, physics='mujoco')


@pytest.mark.parametrize('other', ['detour', 'balance'])
def test_another_task_is_not_mixed_in(other, tmp_path):
    train(preset_for('plate', 'coached'), None, 5, 1, folder=tmp_path, evaluate_every=0)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(TrainingError, match=f"{tmp_path} holds a run with task 'plate', asked for '{other}': ask for"):
        train(preset_for(other, 'coached'), None, 5, 2, folder=tmp_path, evaluate_every=0)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_run_keeps_its_physics_and_goes_on_in_it(tmp_path, monkeypatch, capsys):
    new = ('--task', 'balance', '--episodes', 1, '--evaluate-every', 0, '--output', tmp_path, '--physics', 'mujoco')
    assert command(monkeypatch, *new) == 0
    assert read_run(tmp_path).physics == 'mujoco'
    kept = (tmp_path / 'options.json').read_text()
    assert command(monkeypatch, '--resume', tmp_path, '--physics', 'bullet') == 2
    assert "physics 'mujoco', asked for 'bullet'" in capsys.readouterr().err
    assert (tmp_path / 'options.json').read_text() == kept
    (tmp_path / 'options.json').unlink()  # as an older version left it
    assert command(monkeypatch, '--resume', tmp_path) == 2
    assert "physics 'mujoco', asked for 'bullet'" in capsys.readouterr().err


@pytest.mark.parametrize(('content', 'said'), [
    ('{', 'Invalid JSON'), ('{"preset": "coached", "tutor": null}', 'seed: is missing'),
    ('{"preset": "coached", "tutor": null, "seed": 1, "tests": [[1, "x"]]}', r'tests\.0\.1: .* boolean'),
    ('{"preset": "coached", "tutor": null, "seed": 1, "sed": 1}', 'sed: is not known'),
])
def test_a_damaged_run_is_named(tmp_path, content, said):
    (tmp_path / 'run.json').write_text(content)
    with pytest.raises(TrainingError, match=rf'run\.json is no run: {said}'):
        read_run(tmp_path)


def test_a_policy_that_knows_nothing_does_not_pass(tmp_path):
    run = train(SHORT, None, 5, 2, folder=tmp_path, evaluate_every=2)
    assert run.tests == read_run(tmp_path).tests == [(2, False)]
    assert run.skilled is None


def test_skilled_is_two_tests_in_a_row():
    def run(*passed):
        return TrainingRun('coached', None, 0, tests=list(enumerate(passed, 1)))

    assert run(True, False, True, True, True).skilled == 4
    assert run(False, True, False, True).skilled is None
    assert run(False, True, False).first_pass == 2


def test_human_only_leaves_the_agent_out(tmp_path):
    train(SHORT, EXPERT, 5, 1, human_only=True, folder=tmp_path, evaluate_every=0)
    row, = read_rows(tmp_path / 'episodes.csv')
    assert float(row['mean_abs_agent']) == 0.0
    assert float(row['mean_abs_human']) > 0.0


def command(monkeypatch, *arguments):
    monkeypatch.setattr('sys.argv', ['shared-control', 'train', *map(str, arguments)])
    return main()


def test_command_trains_goes_on_and_tells(tmp_path, monkeypatch, capsys):
    folder, result = tmp_path / 'my run', tmp_path / 'result.json'
    begun = ('--episodes', 2, '--evaluate-every', 0, '--profile', 'low', '--preset', 'coached', '--seed', 3)

    def stop_after_one(*arguments, callbacks, **options):
        def should_stop():
            if folder.joinpath('policy.safetensors').exists():
                raise KeyboardInterrupt
            return False
        callbacks.should_stop = should_stop
        return train(*arguments, callbacks=callbacks, **options)
    with monkeypatch.context() as patch:
        patch.setattr('shared_control_learning.train_command.train', stop_after_one)
        assert command(patch, *begun, '--output', folder) == 130
    [said] = [line for line in capsys.readouterr().err.splitlines() if line.startswith('stopped; go on with: ')]
    assert read_run(folder).episodes == 1
    assert command(monkeypatch, *shlex.split(said.partition(': ')[2])[2:], '--json', result) == 0
    told = json.loads(result.read_text())
    assert [told[name] for name in ('episodes', 'tests', 'tutor', 'preset', 'seed')] == [2, [], 'low', 'coached', 3]
    assert command(monkeypatch, '--output', folder) == 2
    assert f'--resume {shlex.quote(str(folder))}, --overwrite, or another --output' in capsys.readouterr().err
    assert command(monkeypatch, '--episodes', 3, '--resume', folder) == 0
    assert read_run(folder).episodes == 3 and json.loads((folder / 'options.json').read_text())['episodes'] == 3
    (folder / 'options.json').write_text('{"seed": "x"}')
    assert command(monkeypatch, '--resume', folder) == 2
    assert 'options.json holds no options of a run: seed: ' in capsys.readouterr().err


def test_overwriting_removes_what_a_run_writes_and_nothing_else(tmp_path, monkeypatch, capsys):
    short = ('--episodes', 1, '--evaluate-every', 0, '--output', tmp_path)
    assert command(monkeypatch, *short) == 0
    (tmp_path / 'notes.txt').write_text('mine')
    for name in ('events.out.tfevents.1', 'mine.txt'):
        (tmp_path / 'tensorboard' / name).write_text('')
    written = (tmp_path / 'run.json').read_text()
    assert command(monkeypatch, *short, '--overwrite', '--seed', -1) == 2
    assert (tmp_path / 'run.json').read_text() == written, 'refused options leave the earlier run'
    with monkeypatch.context() as patch:
        patch.setattr('shared_control_learning.train_command.train', lambda *_, **__: pytest.fail('two writers'))
        other = RunFolder(tmp_path, 'run', (), 'run.json', ())
        other.claim()
        for choice in (['--overwrite'], ['--resume', tmp_path]):
            assert command(patch, *short, *choice) == 2
            assert 'in use by another run' in capsys.readouterr().err
        other.release()
    assert (tmp_path / 'run.json').read_text() == written
    assert command(monkeypatch, *short, '--overwrite') == 0
    assert (tmp_path / 'notes.txt').read_text() == 'mine'
    assert not (tmp_path / 'tensorboard' / 'events.out.tfevents.1').exists()
    assert (tmp_path / 'tensorboard' / 'mine.txt').exists()


def test_a_run_that_was_killed_in_its_first_episode_can_be_overwritten_and_resumed(tmp_path):
    with pytest.raises(Killed):
        train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0, callbacks=KillIn(1))
    assert read_run(tmp_path).episodes == 0
    assert train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0).episodes == 1


def test_a_run_whose_policy_is_missing_is_refused_and_stays(tmp_path):
    train(SHORT, None, 5, 2, folder=tmp_path, evaluate_every=0)
    (tmp_path / POLICY_NAME).rename(tmp_path / 'elsewhere')
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(TrainingError, match=r'policy\.safetensors is missing, though .*run\.json has 2 episodes'):
        train(SHORT, None, 5, 3, folder=tmp_path, evaluate_every=0)
    with pytest.raises(TrainingError, match='seed 5, asked for 6'):
        train(SHORT, None, 6, 3, folder=tmp_path, evaluate_every=0)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_run_that_was_killed_before_its_first_policy_was_kept_goes_on(tmp_path):
    train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0)
    policy = (tmp_path / POLICY_NAME).read_bytes()
    (tmp_path / POLICY_NAME).unlink()
    assert train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0).episodes == 1
    assert (tmp_path / POLICY_NAME).read_bytes() == policy
    assert len(read_rows(tmp_path / 'episodes.csv')) == 1


@pytest.mark.parametrize(('choice', 'message'), [
    (('--sharing', 'axes'), 'only where a task has two'),
    (('--preset', 'lqr', '--task', 'plate'), 'balance'),
    (('--task', 'detour', '--preset', 'lqr'), 'balance'),
])
def test_a_run_that_cannot_be_done_overwrites_nothing(choice, message, tmp_path, monkeypatch, capsys):
    train(SHORT, None, 5, 1, folder=tmp_path, evaluate_every=0)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.name != '.lock'}
    assert command(monkeypatch, '--output', tmp_path, '--overwrite', '--task', 'balance', *choice) == 2
    assert message in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.name != '.lock'} == before


def test_a_folder_of_something_else_is_refused(tmp_path, monkeypatch, capsys):
    (tmp_path / 'thesis.tex').write_text('years of work')
    assert command(monkeypatch, '--output', tmp_path, '--overwrite') == 2
    assert 'not empty and no run' in capsys.readouterr().err
    assert [child.name for child in tmp_path.iterdir()] == ['thesis.tex']


@pytest.mark.parametrize(('arguments', 'message'), [
    (('--preset', 'autonomous', '--profile', 'low'), 'autonomous has no tutor'),
    (('--episodes', '0'), 'at least 1'),
    (('--until-skilled', '--evaluate-every', '0'), '--until-skilled needs two tests'),
    (('--until-skilled', '--evaluate-every', '2', '--episodes', '3'), '--until-skilled needs two tests'),
    (('--preset', 'autonomous', '--human-only'), '--human-only, but nobody teaches'),
    (('--resume', '.'), 'there is no run'),
    (('--resume', '\x1b[31mred'), r'no run in \x1b[31mred'),
    (('--resume', 'damaged'), 'run.json is no run'),
])
def test_command_refuses(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'damaged').mkdir()
    (tmp_path / 'damaged' / 'run.json').write_text('{')
    assert command(monkeypatch, '--output', tmp_path / 'run', *arguments) == 2
    assert message in capsys.readouterr().err
