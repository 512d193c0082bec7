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

"""A line for every finished episode, for those who see no screen."""

from collections.abc import Callable
from pathlib import Path

from shared_control_learning.episode_table import BROKEN_OFF, read_rows


class EpisodePrinter:
    """Reads the agent's table of episodes as it grows.

    Args:
        path: ``episodes.csv``; it may not exist yet.
        say: told of each new episode.
    """

    def __init__(self, path: Path, say: Callable[[str], None]):
        self._path = path
        self._say = say
        self._told = len(read_rows(path))

    def poll(self) -> None:
        """Tell what is new."""
        rows = read_rows(self._path)
        self._told = min(self._told, len(rows))  # an agent that begins leaves out the rows of an earlier test
        for row in rows[self._told:]:
            self._told += 1
            self._say(
                f'teach {int(row["episode"]):3d}: broken off after {float(row["seconds"]):.1f} s'
                + (f': {row["reason"]}' if row.get('reason') else '')
                if row['phase'] == BROKEN_OFF else
                f'{row["phase"]:>5} {int(row["episode"]):3d}: return {float(row["return"]):8.1f}, '
                f'human share {float(row["human_share"]):4.0%}'
                + (', the ball fell' if int(row['fallen']) else
                   f', at the end {1e3 * float(row["settled_position_error"]):5.1f} mm from the centre'))
