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

"""Bags as a LeRobot data set (format v3.0 of lerobot 0.4 to 0.6; its ``datasets/dataset_writer.py`` is the model).

    meta/info.json                               features, counts, rate
    meta/stats.json                              of each feature over all frames
    meta/tasks.parquet                           the sentence of the task
    meta/episodes/chunk-000/file-000.parquet     a row an episode, with its statistics
    data/chunk-000/file-000.parquet              a row a frame, a row group an episode

One file each suffices: an hour of teaching takes 20 MB, the format asks for a new file at 100 MB.
"""

import json
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from shared_control.files import write_atomically
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.spec_file import panda
from shared_control.tasks.task import Task
from shared_control.wrench import AXIS_NAMES

from .frames import EpisodeFrames, action_rows, common_task

VERSION = 'v3.0'
FILE = 'chunk-{chunk_index:03d}/file-{file_index:03d}'
_UNFINISHED = '.unfinished_export'
"""A file in the folder of a data set as long as it is being written."""
QUANTILES = (0.01, 0.10, 0.50, 0.90, 0.99)
EPISODE_COLUMNS = ('session', 'session_episode', 'phase', 'outcome', 'verdict', 'devices')
"""What the list of episodes has of ours, beside what LeRobot asks for."""


def features(task: Task, with_parts: bool = True) -> dict[str, dict[str, Any]]:
    """The features of a data set of ``task``, SI units, moments along its axes.

    ``action`` is what moved the robot. What agent and human added to it stand beside it under a prefix that LeRobot's
    policies do not take for a further action to be learned, as do the joints and the ball. What the task has a learner
    see stands there twice: some of LeRobot's policies (SAC) ask for ``observation.state``, others (ACT, Diffusion) for
    ``observation.environment_state`` when there is no picture.

    Args:
        with_parts: whether it is known what agent and human gave.
    """
    moments = {who: [f'{AXIS_NAMES[row]}_{who}' for row in action_rows(task)] for who in ('applied', 'agent', 'human')}
    joints, observed = panda().joints, [f'observation_{number}' for number in range(task.observation_size)]
    parts: dict[str, dict[str, Any]] = {} if not with_parts else {
        'complementary_info.action_agent': {'dtype': 'float32', 'names': moments['agent']},
        'complementary_info.action_human': {'dtype': 'float32', 'names': moments['human']},
        'intervention': {'dtype': 'bool', 'names': None}}
    return {
        'observation.state': {'dtype': 'float32', 'names': observed},
        'observation.environment_state': {'dtype': 'float32', 'names': observed},
        'action': {'dtype': 'float32', 'names': moments['applied']},
        **parts,
        'next.reward': {'dtype': 'float32', 'names': None},
        'next.done': {'dtype': 'bool', 'names': None},
        'next.truncated': {'dtype': 'bool', 'names': None},
        'next.success': {'dtype': 'bool', 'names': None},
        'complementary_info.joint_positions': {'dtype': 'float32', 'names': list(joints)},
        'complementary_info.joint_velocities': {'dtype': 'float32', 'names': list(joints)},
        'complementary_info.ball': {'dtype': 'float32', 'names': [
            'position_x', 'position_y', 'position_z', 'velocity_x', 'velocity_y', 'velocity_z']},
        'timestamp': {'dtype': 'float32', 'names': None},
        'frame_index': {'dtype': 'int64', 'names': None},
        'episode_index': {'dtype': 'int64', 'names': None},
        'index': {'dtype': 'int64', 'names': None},
        'task_index': {'dtype': 'int64', 'names': None},
    }


def write_lerobot(episodes: list[EpisodeFrames], folder: Path) -> None:
    """Write the data set into ``folder``, which is made. On an error, or when it is interrupted, nothing is left there.

    What is left of one whose process was killed is known by a file in it, and written anew.

    Args:
        episodes: of one session or several, of one task.

    Raises:
        FileExistsError: it exists and holds something else.
        ValueError: the episodes are not of one task, or some lack the parts of the sum; the message names the sessions.
    """
    task, with_parts = common_task(episodes)
    refuse_filled(folder)
    _remove_parts(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / _UNFINISHED).touch()
        _write(episodes, task, with_parts, folder)
        (folder / _UNFINISHED).unlink()
    except BaseException:  # an interrupt, too: half a data set is in the way of the next
        _remove_parts(folder)
        with suppress(OSError):
            folder.rmdir()
        raise


def _remove_parts(folder: Path) -> None:
    """Remove what was written of a data set that is not finished; nothing else."""
    if (folder / _UNFINISHED).exists():
        for part in ('data', 'meta'):
            shutil.rmtree(folder / part, ignore_errors=True)
        (folder / _UNFINISHED).unlink()


def refuse_filled(folder: Path) -> None:
    """Refuse a folder in which no data set can be made.

    Raises:
        FileExistsError: it exists and is not empty, unless with what is left of an export that was killed.
    """
    if (folder / _UNFINISHED).exists():
        return
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileExistsError(f'{folder} exists already: choose another --output')


def _write(episodes: list[EpisodeFrames], task: Task, with_parts: bool, folder: Path) -> None:
    """Write all files of a data set."""
    data, episodes_path = (folder / 'data' / _first_file(), folder / 'meta' / 'episodes' / _first_file())
    for path in (data, episodes_path):
        path.parent.mkdir(parents=True, exist_ok=True)
    starts = np.cumsum([0, *map(len, episodes)]).tolist()
    columns = [_columns(episode, index, start) for index, (episode, start) in
               enumerate(zip(episodes, starts[:-1], strict=True))]
    schema = _schema(task, with_parts)
    with pq.ParquetWriter(data, schema, compression='snappy') as writer:
        for episode in columns:
            writer.write_table(pa.Table.from_arrays([_array(values) for values in episode.values()], schema=schema))
    rows = [{'episode_index': index, 'tasks': [task.instruction], 'length': len(episodes[index]),
             'data/chunk_index': 0, 'data/file_index': 0,
             'dataset_from_index': starts[index], 'dataset_to_index': starts[index + 1],
             **{f'stats/{feature}/{name}': value for feature, values in _stats(episode).items()
                for name, value in values.items()},
             'meta/episodes/chunk_index': 0, 'meta/episodes/file_index': 0,
             **dict(zip(EPISODE_COLUMNS, _of_the_session(episodes[index]), strict=True))}
            for index, episode in enumerate(columns)]
    pq.write_table(pa.Table.from_pylist(rows), episodes_path)
    sentences = pd.Index([task.instruction], name='task')
    pd.DataFrame({'task_index': [0]}, index=sentences).to_parquet(folder / 'meta' / 'tasks.parquet')
    whole = {name: np.concatenate([episode[name] for episode in columns]) for name in columns[0]}
    _write_json(folder / 'meta' / 'stats.json', _stats(whole))
    # Last: a reader begins with it.
    _write_json(folder / 'meta' / 'info.json', _info(task, with_parts, len(episodes), starts[-1]))


def _first_file() -> str:
    return FILE.format(chunk_index=0, file_index=0) + '.parquet'


def _of_the_session(episode: EpisodeFrames) -> tuple[str, int, str, str, str, str]:
    outcome = 'success' if episode.succeeded else 'failure'
    return episode.session, episode.number, episode.phase, outcome, str(episode.verdict), episode.devices


def _columns(episode: EpisodeFrames, index: int, start: int) -> dict[str, np.ndarray]:
    """The features of an episode, each (n, width) in its type."""
    count = len(episode)
    frames = np.arange(count)
    last = frames == count - 1
    parts = () if episode.human is None or episode.agent is None else (
        _along(episode, episode.agent), _along(episode, episode.human), episode.human.any(axis=1))
    values = (
        episode.observation, episode.observation, _along(episode, episode.applied), *parts, episode.reward, last,
        last & (not episode.failed), last & episode.is_success, episode.q, episode.qd,
        np.column_stack([episode.ball_position, episode.ball_velocity]), frames * POLICY_PERIOD, frames,
        np.full(count, index), frames + start, np.zeros(count))
    named = features(episode.task, episode.human is not None)
    return {name: np.reshape(value, (count, -1)).astype(feature['dtype'])
            for (name, feature), value in zip(named.items(), values, strict=True)}


def _along(episode: EpisodeFrames, moments: np.ndarray) -> np.ndarray:
    """Moments along the task's axes, (n, k), along :func:`action_rows`."""
    wrenches = np.zeros((len(moments), 6))
    wrenches[:, episode.task.axes] = moments
    return wrenches[:, action_rows(episode.task)]


def _shape(feature: dict[str, Any]) -> list[int]:
    return [len(feature['names']) if feature['names'] else 1]


def _schema(task: Task, with_parts: bool) -> pa.Schema:
    """A feature of one number is a column of numbers, a wider one a column of lists of fixed length."""
    fields = []
    for name, feature in features(task, with_parts).items():
        kind, (width,) = pa.type_for_alias(feature['dtype']), _shape(feature)
        fields.append(pa.field(name, kind if width == 1 else pa.list_(kind, width)))
    return pa.schema(fields)


def _array(values: np.ndarray) -> pa.Array:
    width = values.shape[1]
    flat = pa.array(values.ravel())
    return flat if width == 1 else pa.FixedSizeListArray.from_arrays(flat, width)


def _stats(columns: dict[str, np.ndarray]) -> dict[str, dict[str, list]]:
    """LeRobot's statistics of every feature; lists of the feature's width, ``count`` of length 1."""
    return {name: {
        'min': values.min(0).tolist(), 'max': values.max(0).tolist(), 'mean': values.mean(0, float).tolist(),
        'std': values.std(0, float).tolist(), 'count': [len(values)],
        **{f'q{round(100 * q):02d}': np.quantile(values, q, axis=0).tolist() for q in QUANTILES},
    } for name, values in ((name, column.astype(float) if column.dtype == bool else column)
                           for name, column in columns.items())}


def _info(task: Task, with_parts: bool, episodes: int, frames: int) -> dict[str, Any]:
    return {
        'codebase_version': VERSION, 'robot_type': 'panda', 'fps': round(1 / POLICY_PERIOD),
        'total_episodes': episodes, 'total_frames': frames, 'total_tasks': 1, 'splits': {'train': f'0:{episodes}'},
        'chunks_size': 1000, 'data_files_size_in_mb': 100, 'video_files_size_in_mb': 200,
        'data_path': f'data/{FILE}.parquet', 'video_path': None,
        'features': {name: {'dtype': feature['dtype'], 'shape': _shape(feature), 'names': feature['names']}
                     for name, feature in features(task, with_parts).items()}}


def _write_json(path: Path, content: dict[str, Any]) -> None:
    write_atomically(path, (json.dumps(content, indent=2) + '\n').encode())
