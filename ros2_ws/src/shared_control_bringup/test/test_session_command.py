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

"""What ``shared-control session`` checks, writes and removes before and beside the graph, which is left out here."""

import errno
import json
import os
import shutil
import sys
from importlib.resources import files

import pytest
import yaml
from shared_control.cli import main
from shared_control.robot.spec_file import load_robot
from shared_control_bringup import session as command
from shared_control_bringup.interrupts import Interrupts
from shared_control_bringup.page import Page
from shared_control_bringup.parameters import DEFAULTS, load
from shared_control_bringup.settings import Settings
from shared_control_bringup.teaching import End
from shared_control_learning.episode_table import UNFINISHED_NAME
from shared_control_records.session.final_test import sha256
from shared_control_records.session.folder import SessionFolder
from shared_control_testing.sessions import lesson, record
from teach_page_node.address import listen


class NoNeighbours:
    """A domain that nobody else is in; test_neighbours.py looks at real ones."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def refuse(self):
        pass


@pytest.fixture
def session(monkeypatch):
    """``session(*arguments)``: run the command with a graph that is done at once; its exit code."""
    def teach(folder, tutor, shows_screen, page, interrupts, blind):
        run.page = page
        run.taught += 1
        folder.release()
        return run.end, 0, None

    def run(*arguments):
        monkeypatch.setattr('sys.argv', ['shared-control', 'session', *map(str, arguments)])
        return main()

    monkeypatch.setattr(command, 'teach', teach)
    monkeypatch.setattr(command, 'Neighbours', NoNeighbours)
    monkeypatch.setattr(command, '_report', lambda folder, end, *_: end)
    run.end, run.taught = End.DONE, 0
    return run


@pytest.fixture
def few(tmp_path):
    """A parameter file with one value."""
    path = tmp_path / 'few.yaml'
    path.write_text('/**/panda_sim_node:\n  ros__parameters:\n    paced: false  # faster\n')
    return path


def content(path):
    return {file.relative_to(path): file.read_bytes() for file in path.rglob('*') if file.is_file()}


def settings_of(path):
    return json.loads((path / 'settings.json').read_text())


REFUSED = [
    (['--tutor', 'keyboard'], 'there is no terminal'),
    (['--episodes', -1], '--episodes must be at least 0'),
    (['--minutes', 'nan'], '--minutes must be'),
    (['--minutes', 0], '--minutes must be'),
    (['--test-episodes', -2], '--test-episodes must be at least 0'),
    (['--seed', 2**31], '--seed must be'),
    (['--page', '127.0.0.1:0'], '--page belongs to --tutor page'),
    (['--tutor', 'page', '--page', 'no.such.host.invalid:0'], 'cannot serve the page at no.such.host.invalid'),
    (['--tutor', 'page', '--page', 'no.such.host.invalid:8088'], 'cannot serve the page at no.such.host.invalid:8088'),
    (['--preset', 'lqr', '--task', 'plate'], 'lqr knows the task balance'),
    (['--preset', 'pd', '--task', 'plate'], 'pd knows the task balance'),
    (['--preset', 'identified_lqr', '--task', 'detour'], 'identified_lqr needs a task'),
    (['--params-file', 'nowhere.yaml'], 'nowhere.yaml'),
    (['--params-file', 'misspelt.yaml'], "misspelt.yaml: panda_sim_node has no parameter 'pased'"),
    (['--params-file', 'int.yaml'], "int.yaml: parameter 'command_timeout' of torque_ctrl_node must be of type float"),
    (['--params-file', 'wrong.yaml'], "wrong.yaml: there is no node '/**/panda_sim'"),
]


@pytest.mark.parametrize(('arguments', 'said'), REFUSED)
def test_a_refused_start_leaves_everything_as_it_was(session, tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'wrong.yaml').write_text('/**/panda_sim:\n  ros__parameters:\n    seed: 1\n')
    (tmp_path / 'misspelt.yaml').write_text('/**/panda_sim_node: {ros__parameters: {pased: false}}')
    (tmp_path / 'int.yaml').write_text('torque_ctrl_node: {ros__parameters: {command_timeout: 1}}')
    old = tmp_path / 'old'
    assert session('--tutor', 'sim', '--output', old) == 0
    (old / 'learner' / 'policy.safetensors').write_bytes(b'hours of work')
    before = content(old)
    for folder in (old, tmp_path / 'new'):
        assert session('--tutor', 'sim', '--output', folder, '--overwrite', *arguments) == 2
        assert said in capsys.readouterr().err
    assert content(old) == before
    assert not (tmp_path / 'new').exists(), 'a half-made folder would block the next try'


def test_physics_that_are_not_installed_are_refused_before_anything_is_touched(session, tmp_path, monkeypatch, capsys):
    old = tmp_path / 'old'
    assert session('--tutor', 'sim', '--output', old) == 0
    before = content(old)
    monkeypatch.delitem(sys.modules, 'shared_control_sim.mujoco_world', raising=False)
    monkeypatch.setitem(sys.modules, 'mujoco', None)
    assert session('--tutor', 'sim', '--physics', 'mujoco', '--output', old, '--overwrite') == 2
    assert 'pip install "shared-control[mujoco]"' in capsys.readouterr().err
    assert content(old) == before


def test_a_port_that_somebody_else_has_is_refused_before_anything_is_touched(session, tmp_path, capsys):
    old = tmp_path / 'old'
    assert session('--tutor', 'sim', '--output', old) == 0
    before = content(old)
    with listen('127.0.0.1', 0) as taken:
        page = f'127.0.0.1:{taken.getsockname()[1]}'
        assert session('--tutor', 'page', '--page', page, '--output', old, '--overwrite') == 2
    assert f'cannot serve the page at {page}' in capsys.readouterr().err
    assert content(old) == before


def test_a_blind_session_says_neither_condition_nor_folder_and_stays_blind(session, tmp_path, capsys):
    folder = tmp_path / 'session'
    assert session('--tutor', 'page', '--page', '127.0.0.1:0', '--blind', '--output', folder) == 0
    assert session('--resume', folder, '--minutes', 5) == 0
    said = ''.join(capsys.readouterr())
    assert 'coached' not in said and str(folder) not in said
    page = load(folder / 'parameters.yaml')['teach_page_node']
    assert (page['feedback'], page['verdicts'], page['shows_result']) == ('ball', False, False)


def test_a_simulated_tutor_comes_to_an_end(session, tmp_path):
    assert session('--tutor', 'sim', '--output', tmp_path / 'some') == 0
    assert session('--tutor', 'sim', '--episodes', 0, '--output', tmp_path / 'all_minutes') == 0
    assert session('--tutor', 'none', '--output', tmp_path / 'nobody') == 0
    assert [settings_of(tmp_path / name)['episodes'] for name in ('some', 'all_minutes', 'nobody')] == [20, 0, 0]


def test_overwriting_removes_what_a_session_writes_and_nothing_else(session, tmp_path, capsys):
    folder = tmp_path / 'session'
    assert session('--tutor', 'sim', '--output', folder) == 0
    (folder / 'learner' / 'policy.safetensors').write_bytes(b'old')
    (folder / 'notes.txt').write_text('mine')
    assert session('--tutor', 'none', '--output', folder) == 2
    assert 'already holds a session' in capsys.readouterr().err
    assert session('--tutor', 'none', '--output', folder, '--overwrite') == 0
    assert settings_of(folder)['tutor'] == 'none'
    assert not (folder / 'learner' / 'policy.safetensors').exists()
    assert (folder / 'notes.txt').read_text() == 'mine'


def test_two_sessions_in_one_folder_are_refused(session, tmp_path, capsys):
    folder = tmp_path / 'session'
    assert session('--tutor', 'sim', '--output', folder) == 0
    other = SessionFolder.open(folder)
    other.claim()
    before = content(folder)
    for arguments in (['--tutor', 'sim', '--output', folder, '--overwrite'], ['--resume', folder, '--episodes', 2]):
        assert session(*arguments) == 2
        assert 'in use by another session' in capsys.readouterr().err
    assert content(folder) == before


def test_a_file_with_a_few_values_is_laid_over_the_defaults(session, few, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    assert session('--tutor', 'sim', '--output', folder.path, '--params-file', few, '--seed', 3) == 0
    assert folder.given_parameters.read_text() == few.read_text()
    assert folder.ros_parameters('panda_sim_node') == {
        **load()['panda_sim_node'], 'task': 'balance', 'physics': 'bullet', 'paced': False, 'seed': 3}
    assert folder.ros_parameters('torque_ctrl_node')['enabled'] is True, 'beside a simulator'
    assert folder.ros_parameters('ppo_agent_node')['test_episodes'] == load()['ppo_agent_node']['test_episodes']


def test_parameters_can_come_from_a_pipe(session, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    text = 'panda_sim_node: {ros__parameters: {paced: false}}'
    pipe, theirs = os.pipe()
    os.write(theirs, text.encode())
    os.close(theirs)
    try:
        assert session('--tutor', 'sim', '--output', folder.path, '--params-file', f'/dev/fd/{pipe}') == 0
    finally:
        os.close(pipe)
    assert folder.ros_parameters('panda_sim_node')['paced'] is False
    assert folder.given_parameters.read_text() == text


def test_a_session_goes_on_with_its_parameters_and_the_options_given_now(session, few, tmp_path, monkeypatch):
    folder = SessionFolder(tmp_path / 'session')
    assert session('--tutor', 'sim', '--output', folder.path, '--params-file', few, '--episodes', 5) == 0
    few.unlink()
    monkeypatch.chdir(tmp_path.parent)
    assert session('--resume', folder.path) == 0
    assert folder.ros_parameters('panda_sim_node')['paced'] is False
    assert folder.ros_parameters('ppo_agent_node')['episodes'] == 5
    assert session('--resume', folder.path, '--episodes', 9, '--minutes', 3, '--profile', 'low', '--no-screen') == 0
    assert folder.ros_parameters('ppo_agent_node')['episodes'] == 9
    assert folder.ros_parameters('sim_tutor_node')['profile'] == 'low'
    assert session('--resume', folder.path) == 0
    kept = settings_of(folder.path)
    assert (kept['episodes'], kept['minutes'], kept['tutor'], kept['screen']) == (9, 3.0, 'simulated: low', False)
    assert kept['earlier_tutors'] == ['simulated: expert']
    assert folder.ros_parameters('ppo_agent_node')['max_minutes'] == 3.0


def test_the_file_of_a_robot_is_found_from_wherever_a_session_goes_on(session, tmp_path, monkeypatch):
    folder = SessionFolder(tmp_path / 'session')
    shutil.copy(files('shared_control') / 'robot' / 'specs' / 'panda.yaml', tmp_path / 'arm.yaml')
    monkeypatch.chdir(tmp_path)
    session.end = End.STOPPED
    assert session('--tutor', 'sim', '--robot', './arm.yaml', '--output', folder.path) == 130
    (tmp_path / 'elsewhere').mkdir()
    monkeypatch.chdir(tmp_path / 'elsewhere')
    load_robot.cache_clear()
    assert session('--resume', folder.path) == 130
    assert folder.ros_parameters('panda_sim_node')['robot'] == str(tmp_path / 'arm.yaml')


@pytest.mark.parametrize('arguments', [
    ['--preset', 'thesis'], ['--task', 'plate'],
    ['--seed', 1], ['--output', 'elsewhere'], ['--overwrite'], ['--params-file', DEFAULTS],
    ['--episodes', -1], ['--tutor', 'keyboard']])
def test_what_cannot_change_when_a_session_goes_on_is_refused(session, tmp_path, capsys, arguments):
    folder = tmp_path / 'session'
    assert session('--tutor', 'sim', '--output', folder) == 0
    before = content(folder)
    assert session('--resume', folder, *arguments) == 2
    assert (arguments[0] if arguments[0] != '--tutor' else 'no terminal') in capsys.readouterr().err
    assert content(folder) == before


@pytest.mark.parametrize('term', ['dumb', ''])
def test_a_terminal_that_cannot_draw_is_refused_where_keys_are_to_be_read(session, tmp_path, monkeypatch, capsys, term):
    monkeypatch.setattr(command, '_has_terminal', lambda: True)
    monkeypatch.setenv('TERM', term)
    folder = tmp_path / 'session'
    assert session('--tutor', 'keyboard', '--output', folder) == 2
    assert f'TERM is {term!r}' in capsys.readouterr().err and not folder.exists()
    assert session('--tutor', 'sim', '--output', folder) == 0
    assert SessionFolder(folder).ros_parameters('teleop_key_node')['screen'] == 'off', 'lines are printed instead'


def test_a_session_that_is_taught_goes_on_with_its_test_alone(session, tmp_path, capsys):
    folder = SessionFolder(tmp_path / 'session')
    session.end = End.STOPPED
    assert session('--tutor', 'sim', '--output', folder.path) == 130
    session.end = End.DONE
    assert session('--resume', folder.path) == 0, 'the teaching, which was broken off'
    assert session.taught == 2
    assert session('--resume', folder.path) == 0, 'the test, which is missing'
    assert 'the teaching is over' in capsys.readouterr().out and session.taught == 2
    folder.test.write_text('{"episodes": []}')
    assert session('--resume', folder.path, '--test-episodes', 3) == 0, 'another test'
    assert session.taught == 2
    assert session('--resume', folder.path) == 0, 'nothing else is left to do: more teaching'
    assert session.taught == 3
    assert session('--resume', folder.path, '--episodes', 50) == 0
    assert session.taught == 4


def test_who_asks_a_session_for_something_else_goes_on_teaching(session, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    session.end = End.STOPPED
    assert session('--tutor', 'sim', '--output', folder.path) == 130
    folder.last_episode.write_text('{}')
    for same in ([], ['--test-episodes', 3]):
        session('--resume', folder.path, *same)
        assert folder.last_episode.exists(), 'the agent goes by it'
    session('--resume', folder.path, '--minutes', 60)
    assert not folder.last_episode.exists()


def test_a_session_that_is_not_to_be_tested_goes_on_with_its_teaching(session, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    assert session('--tutor', 'sim', '--test-episodes', 0, '--output', folder.path) == 0
    assert session('--resume', folder.path) == 0
    assert session.taught == 2
    assert session('--resume', folder.path, '--test-episodes', 3) == 0
    assert session.taught == 2, 'now it is to be tested, and that is all that is left'


def test_a_session_in_which_nothing_was_learned_has_a_report(tmp_path, capsys):
    folder = SessionFolder(tmp_path / 'session')
    record([lesson()]).write(folder.bag)
    folder.learner.mkdir()
    folder.episodes.with_name(UNFINISHED_NAME).write_text(
        'episode,phase,seconds,return,fallen,human_share\n1,broken off,4.0,-1.0,0,0.5\n')  # the learner was killed
    folder.write_settings((settings := Settings(tutor='sim', test_episodes=20)).to_json())
    assert command._conclude(folder, End.DONE, 0, settings, Interrupts()) is End.DONE
    assert 'No episode was learned' in capsys.readouterr().out
    assert folder.report.exists() and not folder.test.exists()
    assert json.loads(folder.summary.read_text())['episodes_broken_off'] == 1


def test_a_disk_that_is_full_after_the_teaching_is_said_with_the_way_to_go_on(session, tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(errno.ENOSPC, 'No space left on device')

    monkeypatch.setattr(command, '_report', full)
    assert session('--tutor', 'sim', '--output', tmp_path / 'session') == 1
    said = capsys.readouterr()
    assert f'No space left on device; what there is of the session is kept in {tmp_path / "session"}' in said.err
    assert f'--resume {tmp_path / "session"}' in said.out


def test_a_test_does_not_outlive_the_policy_that_it_was_of(session, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    assert session('--tutor', 'sim', '--output', folder.path) == 0
    folder.policy.write_bytes(b'as it was tested')
    folder.test.write_text(json.dumps({'episodes': [], 'policy': sha256(folder.policy)}))
    assert session('--resume', folder.path) == 0
    assert folder.test.exists(), 'nothing was learned since'
    folder.policy.write_bytes(b'as it has learned since')
    assert session('--resume', folder.path) == 0
    assert not folder.test.exists()


@pytest.mark.parametrize(('name', 'text', 'said'), [
    ('settings.json', None, 'settings.json is missing'),
    ('settings.json', '{"episodes": "many"}', "settings.json: episodes: Input should be a valid integer, found 'many'"),
    ('settings.json', '{"test_episodes": 2.5}', 'settings.json: test_episodes: Input should be a valid integer'),
    ('test.json', '{"episodes": [', 'test.json is no result of a test'),
    ('summary.json', '{"restarts": "2"}', 'summary.json: restarts: '),
    ('summary.json', '{"restarts": 2', 'summary.json: '),
    ('given_parameters.yaml', None, 'given_parameters.yaml')])
def test_a_session_whose_files_are_damaged_does_not_go_on(session, tmp_path, capsys, name, text, said):
    folder = tmp_path / 'session'
    session.end = End.STOPPED
    assert session('--tutor', 'sim', '--output', folder) == 130
    (folder / 'bag').mkdir()
    if text is None:
        (folder / name).unlink()
    else:
        (folder / name).write_text(text)
    before = content(folder)
    assert session('--resume', folder) == 2
    assert said in capsys.readouterr().err
    assert content(folder) == before


def test_a_token_that_a_file_gives_to_all_nodes_is_recorded_of_none():
    parameters = {'panda_sim_node': {'token': 'secret', 'seed': 1}, 'teach_page_node': {'token': 'secret'}}
    page = Page.choose(Settings(tutor='page', page=('0.0.0.0', 0)), parameters)
    assert page.token == 'secret' and parameters == {'panda_sim_node': {'seed': 1}, 'teach_page_node': {}}


def test_the_session_chooses_the_port_of_its_page_and_keeps_the_token_to_itself(session, tmp_path):
    folder = SessionFolder(tmp_path / 'session')
    assert session('--tutor', 'page', '--page', '127.0.0.1:0', '--output', folder.path) == 0
    port = folder.ros_parameters('teach_page_node')['port']
    assert port > 0 and settings_of(folder.path)['page'] == ['127.0.0.1', 0]
    assert session.page.address == f'http://127.0.0.1:{port}/' and session.page.environment == {}

    mine = tmp_path / 'mine.yaml'
    mine.write_text(yaml.safe_dump({'teach_page_node': {'ros__parameters': {'token': 'secret'}}}))
    for options in ([], ['--params-file', mine]):
        assert session('--tutor', 'page', '--page', '0.0.0.0:0', '--output', folder.path, '--overwrite', *options) == 0
        token = session.page.environment['teach_page_node']['SHARED_CONTROL_PAGE_TOKEN']
        assert session.page.address.endswith(f'/?token={token}')
        assert not any(token in file.read_text() for file in folder.path.rglob('*.*'))
    assert token == 'secret'
    assert session('--resume', folder.path, '--episodes', 9) == 0
    token = session.page.environment['teach_page_node']['SHARED_CONTROL_PAGE_TOKEN']
    assert token not in ('', 'secret') and not any(token in file.read_text() for file in folder.path.rglob('*.*'))
