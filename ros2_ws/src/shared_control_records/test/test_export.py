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

"""A bag as Parquet and as a LeRobot data set, read back."""

import json
import shutil
import signal
import subprocess
import sys

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from shared_control import contract
from shared_control.cli import main
from shared_control.plant import PlantState
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import Balance
from shared_control.tasks.plate import Plate
from shared_control_records.bag.reader import read_bag
from shared_control_records.export.frames import episode_frames, session_names
from shared_control_records.export.lerobot import features, write_lerobot
from shared_control_records.export.parquet import write_parquet
from shared_control_testing import sessions as made

STEPS = (50, 80)


@pytest.fixture(scope='module')
def lessons():
    return [made.lesson(steps, seed=seed) for seed, steps in enumerate(STEPS)]


@pytest.fixture(scope='module')
def bag(lessons, tmp_path_factory):
    return made.record(lessons).write(tmp_path_factory.mktemp('made') / 'bag')


@pytest.fixture(scope='module', params=[Balance, Plate])
def frames(request, bag):
    """As of the task of the thesis, and as of one with two axes, of which the first rests."""
    return episode_frames(read_bag(bag, request.param()))


def test_a_frame_a_policy_step_with_who_did_what(frames, lessons):
    assert tuple(map(len, frames)) == STEPS
    for frame, lesson in zip(frames, lessons, strict=True):
        assert (np.diff(frame.stamp_ns) == 20 * made.MS).all()
        assert frame.agent[:, -1] == pytest.approx(lesson.m_y_agent)
        assert frame.human[:, -1] == pytest.approx(lesson.m_y_human)
        assert frame.applied[:, -1] == pytest.approx(lesson.m_y_agent + lesson.m_y_human)
        if len(frame.task.axes) == 1:
            assert frame.position_error == pytest.approx(lesson.position_error)
        else:
            assert frame.position_error == pytest.approx(np.hypot(*frame.on_tray.T))
            assert not frame.human[:, 0].any() and frame.human.shape == (len(frame), 2)
        assert frame.q == pytest.approx(np.tile(panda().home, (len(frame), 1)))


def test_moments_are_those_that_counted_not_those_that_were_asked_for(lessons, tmp_path):
    recording = made.record(lessons[:1])
    for sent in recording.of(contract.HUMAN_APPLIED):
        sent.wrench.torque.y /= 2.0
    human = episode_frames(read_bag(recording.write(tmp_path / 'bag')))[0].human[:, 0]
    assert human == pytest.approx(lessons[0].m_y_human / 2.0)
    assert abs(human[10]) == 2.5


@pytest.mark.parametrize('topic', made.APPLIED)
def test_a_bag_of_which_a_moment_that_counted_is_missing_is_refused(lessons, tmp_path, topic):
    bag = read_bag(made.record(lessons[:1]).write(tmp_path / 'bag', without=(topic,)))
    with pytest.raises(ValueError, match=f'no messages on {topic.full_name}'):
        episode_frames(bag)


def test_a_bag_without_the_parts_of_the_sum_is_exported_without_them(lessons, frames, tmp_path):
    bag = made.record(lessons).write(tmp_path / 'bag', without=(contract.HUMAN_APPLIED, contract.AGENT_APPLIED))
    without = episode_frames(read_bag(bag, frames[0].task))
    write_parquet(without, tmp_path / 'one.parquet')
    table = pd.read_parquet(tmp_path / 'one.parquet')
    assert {'m_y_applied', 'reward'} <= set(table) and not {'m_y_human', 'm_y_agent'} & set(table)
    write_lerobot(without, tmp_path / 'set')
    named = json.loads((tmp_path / 'set/meta/info.json').read_text())['features']
    assert 'action' in named and 'intervention' not in named and 'complementary_info.action_human' not in named
    for write in (write_lerobot, write_parquet):
        with pytest.raises(ValueError, match=r': \w+, with the parts of the sum; .*, without.*export them apart'):
            write([*frames, *without], tmp_path / 'both')


def test_a_step_has_what_the_learner_saw_and_earned(frames):
    task, model = frames[0].task, RobotModel()
    for frame in frames:
        none = np.zeros(len(task.axes))
        states = [task.describe(PlantState(q, tuple(ball), tuple(velocity), none, none, none), model)
                  for q, ball, velocity in zip(frame.q, frame.ball_position, frame.ball_velocity, strict=True)]
        np.testing.assert_array_equal(frame.observation, [task.observe(state) for state in states])
        assert frame.reward[:-1] == pytest.approx([sum(task.reward_terms(state).values()) for state in states[1:]])
        assert not frame.failed
    assert [frame.succeeded for frame in frames] == [
        task.succeeded(np.append(frame.position_error[1:], frame.position_error[-1]), np.zeros(len(frame)), False)
        for frame in frames]


def test_parquet_is_read_back_with_units(frames, tmp_path):
    write_parquet(frames, tmp_path / 'session.parquet')
    table = pd.read_parquet(tmp_path / 'session.parquet')
    assert len(table) == sum(STEPS)
    assert table.groupby('episode').size().tolist() == list(STEPS)
    assert table.m_y_applied.to_numpy() == pytest.approx((table.m_y_agent + table.m_y_human).to_numpy())
    schema = pq.read_schema(tmp_path / 'session.parquet')
    units = {name: (schema.field(name).metadata or {}).get(b'unit') for name in schema.names}
    assert units['qd7'] == b'rad/s' and units['q1'] == b'rad' and units['m_y_human'] == b'N m'
    if len(frames[0].task.axes) > 1:
        assert units['m_x_human'] == b'N m' and units['on_tray_y'] == b'm' and units['ball_vy'] == b'm/s'
        assert not table.m_x_applied.any()
    assert units['ball_x'] == b'm' and units['ball_vx'] == b'm/s' and units['episode'] is None


def test_the_lerobot_data_set_keeps_the_rules_of_its_layout(frames, tmp_path):
    """What ``LeRobotDatasetMetadata`` and ``DatasetReader`` of lerobot rely on."""
    root = tmp_path / 'set'
    write_lerobot(frames, root)
    info = json.loads((root / 'meta/info.json').read_text())
    assert (info['codebase_version'], info['fps']) == ('v3.0', 50)
    assert (info['total_episodes'], info['total_frames'], info['total_tasks']) == (len(STEPS), sum(STEPS), 1)
    assert info['splits'] == {'train': f'0:{len(STEPS)}'}

    tasks = pd.read_parquet(root / 'meta/tasks.parquet')
    assert tasks.index.name == 'task' and tasks.loc[frames[0].task.instruction, 'task_index'] == 0

    episodes = pd.read_parquet(root / 'meta/episodes/chunk-000/file-000.parquet')
    assert episodes.length.tolist() == list(STEPS)
    assert episodes.dataset_to_index.tolist() == [50, 130] and episodes.dataset_from_index.tolist() == [0, 50]
    for _, episode in episodes.iterrows():
        path = root / info['data_path'].format(
            chunk_index=episode['data/chunk_index'], file_index=episode['data/file_index'])
        group = pq.ParquetFile(path).read_row_group(episode.episode_index).to_pandas()
        assert group['index'].tolist() == list(range(episode.dataset_from_index, episode.dataset_to_index))
        assert (group.episode_index == episode.episode_index).all()
        assert group.timestamp.to_numpy() == pytest.approx(np.arange(episode.length) / info['fps'], abs=1e-4)
        assert episode['stats/action/mean'][0] == pytest.approx(
            np.stack(group.action.to_numpy()).reshape(episode.length, -1)[:, 0].mean(), abs=1e-5)

    assert episodes.session_episode.tolist() == [1, 2] and set(episodes.phase) == {'teach'}
    assert set(episodes.devices) == {'keys (tutor)'}
    whole = pd.read_parquet(root / 'data/chunk-000/file-000.parquet')
    assert np.flatnonzero(whole['next.done']).tolist() == np.flatnonzero(whole['next.truncated']).tolist() == [49, 129]
    assert whole['intervention'].sum() == sum((frame.human != 0).any(axis=1).sum() for frame in frames)
    rewards = np.concatenate([frame.reward for frame in frames])
    assert whole['next.reward'].to_numpy() == pytest.approx(rewards, rel=1e-5)
    assert episodes.outcome.tolist() == ['success' if frame.succeeded else 'failure' for frame in frames]

    schema = pq.read_schema(root / 'data/chunk-000/file-000.parquet')
    stats = json.loads((root / 'meta/stats.json').read_text())
    assert schema.names == list(info['features']) == list(stats) == list(features(frames[0].task))
    for name, feature in info['features'].items():
        width, = feature['shape']
        kind = schema.field(name).type
        assert (kind if width == 1 else kind.value_type) == pa.type_for_alias(feature['dtype'])
        assert width == 1 or kind.list_size == width == len(feature['names'])
        assert len(stats[name]['mean']) == width and stats[name]['count'] == [sum(STEPS)]


@pytest.mark.parametrize('was_there', [False, True])
def test_an_interrupted_data_set_is_not_in_the_way_of_the_next(frames, tmp_path, monkeypatch, was_there):
    def interrupted(*_):
        raise KeyboardInterrupt

    if was_there:
        (tmp_path / 'set').mkdir()
    with monkeypatch.context() as patch:
        patch.setattr('shared_control_records.export.lerobot._write_json', interrupted)
        with pytest.raises(KeyboardInterrupt):
            write_lerobot(frames, tmp_path / 'set')
    assert list(tmp_path.rglob('*.parquet')) == []
    write_lerobot(frames, tmp_path / 'set')
    assert not list((tmp_path / 'set').glob('.*'))


KILLED = """
import os, pathlib, signal, sys
from shared_control_records.export import lerobot
def written(episodes, task, with_parts, folder):
    for part in ('data', 'meta'):
        (folder / part).mkdir()
    os.kill(os.getpid(), signal.SIGKILL)
lerobot._write, lerobot.common_task = written, lambda _: (None, False)
lerobot.write_lerobot([], pathlib.Path(sys.argv[1]))
"""


def test_what_is_left_of_a_data_set_whose_export_was_killed_is_not_in_the_way(frames, tmp_path):
    killed = [sys.executable, '-c', KILLED, tmp_path / 'set']
    assert subprocess.run(killed, check=False).returncode == -signal.SIGKILL
    assert sorted(path.name for path in (tmp_path / 'set').iterdir()) == ['.unfinished_export', 'data', 'meta']
    write_lerobot(frames, tmp_path / 'set')
    with pytest.raises(FileExistsError, match='choose another'):
        write_lerobot(frames, tmp_path / 'set')


def test_the_command_says_where_and_never_overwrites_what_is_not_its_own(bag, tmp_path, monkeypatch, capsys):
    def run(*arguments):
        monkeypatch.setattr('sys.argv', ['shared-control', 'export', *map(str, arguments)])
        return main()

    mcap, = bag.glob('*.mcap')
    assert run(mcap, '--output', tmp_path / 'one.parquet') == 0
    assert f'130 frames of 2 episodes in {tmp_path / "one.parquet"}' in capsys.readouterr().out
    for code, said in ((0, 'frames'), (2, 'exists already')):
        assert run(bag, '--format', 'lerobot', '--output', tmp_path / 'set') == code
        assert said in ''.join(capsys.readouterr())
    notes = tmp_path / 'notes.txt'
    notes.write_text('of somebody')
    assert run(bag, '--output', notes) == 2 and notes.read_text() == 'of somebody'
    assert f'{notes} exists already and is no Parquet file' in capsys.readouterr().err
    assert run(mcap, '--output', tmp_path / 'one.parquet') == 0, 'it may be made anew'
    shutil.copytree(bag, tmp_path / 'copy')
    assert run(bag, tmp_path / 'copy', '--format', 'lerobot', '--output', tmp_path / 'two') == 0
    assert '260 frames of 4 episodes' in capsys.readouterr().out
    two = pd.read_parquet(tmp_path / 'two/meta/episodes/chunk-000/file-000.parquet')
    assert two.session_episode.tolist() == [1, 2, 1, 2]
    assert run(mcap, '--task', 'plate', '--output', tmp_path / 'plate.parquet') == 0
    assert 'm_x_applied' in pd.read_parquet(tmp_path / 'plate.parquet')
    capsys.readouterr()
    assert run(tmp_path / 'none.mcap') == 2
    assert 'there is no bag' in capsys.readouterr().err


@pytest.fixture
def export(tmp_path, monkeypatch, capsys):
    """``export(session, ...)``: exit code, and what was said."""
    def run(*sessions):
        monkeypatch.setattr('sys.argv', ['shared-control', 'export', *map(str, sessions),
                                         '--output', str(tmp_path / 'one.parquet')])
        return main(), ''.join(capsys.readouterr())
    return run


def session(bag, folder, task='balance'):
    shutil.copytree(bag, folder / 'bag')
    (folder / 'settings.json').write_text(json.dumps({'task': task}))
    return folder


@pytest.mark.parametrize(('folders', 'named'), [
    (('p01/coached', 'p02/thesis'), ['coached', 'thesis']),
    (('p01/coached', 'p02/coached', 'p02/thesis'), ['p01/coached', 'p02/coached', 'p02/thesis'])])
def test_sessions_go_by_what_tells_them_apart(bag, tmp_path, export, folders, named):
    code, _ = export(*(session(bag, tmp_path / 'people' / folder) for folder in folders))
    table = pd.read_parquet(tmp_path / 'one.parquet')
    assert code == 0 and table.groupby('session').size().to_dict() == dict.fromkeys(named, sum(STEPS))


def test_names_are_those_of_folders_as_they_are(tmp_path):
    for name in ('at.noon', 'at.night'):
        (tmp_path / name).mkdir()
    (tmp_path / 'one.mcap').touch()
    assert session_names([tmp_path / 'at.noon', tmp_path / 'x' / '..' / 'at.night', tmp_path / 'one.mcap']) == [
        'at.noon', 'at.night', 'one']
    parts = [tmp_path / 's1' / 'bag' / f'bag_{number}.mcap' for number in range(2)]
    parts[0].parent.mkdir(parents=True)
    for part in parts:
        part.touch()
    assert session_names(parts) == ['s1', 's1'], 'two files of a bag are of one session'


def test_a_session_that_is_given_twice_is_refused(bag, tmp_path, export):
    one = session(bag, tmp_path / 's1')
    file, = (one / 'bag').glob('*.mcap')
    (tmp_path / 'link').symlink_to(one)
    for other in (one, one / 'bag', file, tmp_path / 'link', one / '..' / 's1'):
        code, said = export(one, other)
        assert code == 2 and f'the bag {file if other == file else one / "bag"} is given twice' in said


def test_sessions_of_several_tasks_are_refused_before_one_is_read(bag, tmp_path, export, monkeypatch):
    monkeypatch.setattr('shared_control_records.bag.reader._Collector', None)
    code, said = export(*(session(bag, tmp_path / task, task) for task in ('balance', 'plate', 'detour')))
    assert code == 2 and 'these sessions differ (balance: balance; plate: plate; detour: detour): export them' in said
