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

"""A bag as one Parquet file: a row every 20 ms, a column a number."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from shared_control.files import write_atomically
from shared_control.wrench import AXIS_NAMES

from .frames import EpisodeFrames, common_task

UNITS = {'seconds': 's', 'stamp_ns': 'ns', 'q': 'rad', 'qd': 'rad/s', 'ball': 'm', 'ball_v': 'm/s',
         'position_error': 'm', 'pitch': 'rad', 'on_tray': 'm', **dict.fromkeys(AXIS_NAMES[3:], 'N m')}
"""By the beginning of a column's name; the longest that fits counts."""
MAGIC = b'PAR1'
"""What every Parquet file begins with."""


def write_parquet(episodes: list[EpisodeFrames], path: Path) -> None:
    """Write the episodes to ``path``. Each column carries its unit in the metadata of its field.

    Args:
        episodes: of one session or several, of one task.

    Raises:
        ValueError: the episodes are not of one task, or some lack the parts of the sum; the message names the sessions.
    """
    common_task(episodes)
    content = pa.BufferOutputStream()
    pq.write_table(pa.concat_tables([_table(episode) for episode in episodes]), content)
    write_atomically(path, content.getvalue())


def _table(episode: EpisodeFrames) -> pa.Table:
    joints = range(episode.q.shape[1])
    columns = {
        'session': np.full(len(episode), episode.session),
        'episode': np.full(len(episode), episode.number), 'phase': np.full(len(episode), episode.phase),
        'verdict': np.full(len(episode), str(episode.verdict)), 'devices': np.full(len(episode), episode.devices),
        'frame': np.arange(len(episode)), 'seconds': (episode.stamp_ns - episode.stamp_ns[0]) * 1e-9,
        'stamp_ns': episode.stamp_ns,
        **{f'q{joint + 1}': episode.q[:, joint] for joint in joints},
        **{f'qd{joint + 1}': episode.qd[:, joint] for joint in joints},
        **{f'ball_{axis}': episode.ball_position[:, index] for index, axis in enumerate('xyz')},
        **{f'ball_v{axis}': episode.ball_velocity[:, index] for index, axis in enumerate('xyz')},
        'position_error': episode.position_error, 'pitch': episode.pitch,
        **{f'on_tray_{axis}': episode.on_tray[:, index] for index, axis in enumerate('xy')},
        **{f'lean_{axis}': episode.lean[:, index] for index, axis in enumerate('xy')},
        **{f'{AXIS_NAMES[row]}_{who}': moments[:, axis] for who, moments in (
            ('agent', episode.agent), ('human', episode.human), ('applied', episode.applied)) if moments is not None
           for axis, row in enumerate(episode.task.axes)},
        'reward': episode.reward}
    arrays = [pa.array(column) for column in columns.values()]
    return pa.Table.from_arrays(arrays, schema=pa.schema(
        [pa.field(name, array.type, metadata=_unit(name)) for name, array in zip(columns, arrays, strict=True)]))


def _unit(column: str) -> dict[str, str]:
    fitting = [name for name in UNITS if column.startswith(name)]
    return {'unit': UNITS[max(fitting, key=len)]} if fitting else {}
