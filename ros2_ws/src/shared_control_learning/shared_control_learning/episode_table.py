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

"""``episodes.csv``: one row for every episode, written as they end."""

import csv
import io
import os
from contextlib import suppress
from pathlib import Path

from shared_control.files import write_atomically
from shared_control.verdict import Verdict

from .episode import Episode

TABLE_NAME = 'episodes.csv'
"""Name of the file in a learner's folder."""
UNFINISHED_NAME = 'unfinished.csv'
"""Beside it: the episode that is under way, as far as it has come."""
BROKEN_OFF = 'broken off'
"""Phase of an episode that the learner has not learned from: repeated, stopped, or cut short by a fault."""
KILLED = 'the learner was killed'
"""Why an episode was broken off whose end the learner did not see."""
LATER = ('verdict', 'reason')
"""The last columns, which tables of earlier versions have not."""
TEXTS = ('phase', *LATER)
"""Columns that hold no numbers."""


class EpisodeTable:
    """Appends rows, each on disk before the next episode begins.

    Args:
        path: of the file.
        taught: episodes that the learner has learned from. Rows of an earlier test and a half-written last line are
            dropped; for rows of later episodes, left by a run that was killed before it saved its learner, see:
        live: whether episodes take somebody's time: those that were broken off are kept then. They are dropped where
            they can be done again as they were.

    Raises:
        ValueError: there is a file that is no such table; the message names it.
    """

    def __init__(self, path: Path, taught: int = 0, live: bool = False):
        self._path, self._unfinished = path, path.with_name(UNFINISHED_NAME)
        before = read_rows(path)
        rows = [row for row in before if row['phase'] == 'teach' and int(row['episode']) <= taught]
        if live:
            rows = [row if row['phase'] == BROKEN_OFF or int(row['episode']) <= taught or _is_discarded(row)
                    else {**row, 'phase': BROKEN_OFF, 'reason': KILLED}
                    for row in before if row['phase'] in ('teach', BROKEN_OFF)]
            rows += _missing(path, before)
        rows = [{**{name: value for name, value in row.items() if name not in LATER}, **{
            name: row.get(name, '') for name in LATER}} for row in rows]
        self._has_header = bool(rows)
        self._last: tuple[Episode, int, int] | None = None
        """The episode appended last, and where in the file its row begins and ends."""
        if any('seconds' not in row for row in rows):
            raise ValueError(f'{path} is no table of episodes: it has no column seconds')
        self.taught_seconds = sum(float(row['seconds']) + float(row.get('learn_seconds', 0.0)) for row in rows)
        """How long the learner was taught before, s: its episodes by the robot's time, and the time of learning."""
        _write(path, rows)
        self._unfinished.unlink(missing_ok=True)

    def append(self, episode: Episode) -> None:
        """The row of an episode that has ended."""
        end = self._append(episode.row())
        self._last = episode, end - len(_csv([list(episode.row().values())]).encode()), end

    def amend(self, episode: Episode) -> None:
        """Write the row of the episode that was appended last anew; nothing when that was another."""
        if self._last is None or self._last[0] is not episode:
            return
        _, begin, end = self._last
        content, row = self._path.read_bytes(), _csv([list(episode.row().values())]).encode()
        write_atomically(self._path, content[:begin] + row + content[end:])
        self._last = episode, begin, begin + len(row)

    def break_off(self, episode: Episode, reason: str) -> None:
        """The row of an episode that will not be learned from; none when it has not begun."""
        episode.reason = reason
        if len(episode):
            self._append({**episode.row(), 'phase': BROKEN_OFF})

    def under_way(self, episode: Episode) -> None:
        """Keep how far an episode has come, for the case that this process does not see its end."""
        row = {**episode.row(), 'phase': BROKEN_OFF, 'reason': KILLED}
        with suppress(OSError):  # a full disk is an error at the episode's end
            write_atomically(self._unfinished, _csv([list(row), list(row.values())]).encode(), synced=False)

    def _append(self, row: dict[str, float | int | str]) -> int:
        """Write a row; gives where it ends in the file."""
        lines = _csv([list(row.values())] if self._has_header else [list(row), list(row.values())])
        with self._path.open('a', encoding='utf-8', newline='') as file:
            file.write(lines)
            file.flush()
            os.fsync(file.fileno())
            end = file.tell()
        self._has_header = True
        self._unfinished.unlink(missing_ok=True)
        return end


def keep_unfinished(path: Path) -> None:
    """Give an episode its row whose end a killed learner did not see; nothing when there is none.

    Raises:
        ValueError: a file is no such table; the message names it.
        OSError: the table cannot be written.
    """
    rows = read_rows(path)
    if missing := _missing(path, rows):
        _write(path, [*rows, *missing])
        path.with_name(UNFINISHED_NAME).unlink()


def _missing(path: Path, rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """The row of the episode that was under way, if the table has none of it."""
    return [row for row in read_rows(path.with_name(UNFINISHED_NAME)) if not _is_same(row, rows[-1:]) and not any(
        other['phase'] == 'teach' and other['episode'] == row['episode'] and not _is_discarded(other)
        for other in rows)]


def _write(path: Path, rows: list[dict[str, str]]) -> None:
    text = _csv([list(rows[0])]) + _csv([list(row.values()) for row in rows]) if rows else ''
    write_atomically(path, text.encode())


def _is_same(row: dict[str, str], last: list[dict[str, str]]) -> bool:
    """Whether it is the last row of a table, but for the reason, which an episode under way has not had yet."""
    return any({**other, 'reason': ''} == {**row, 'reason': ''} for other in last)


def _is_discarded(row: dict[str, str]) -> bool:
    return row.get('verdict') == Verdict.DISCARD


def read_rows(path: Path) -> list[dict[str, str]]:
    """The complete rows by column name; none when there is no file.

    Raises:
        ValueError: it is no table of episodes; the message names it.
    """
    if not path.exists():
        return []
    try:
        with path.open(encoding='utf-8', newline='') as file:
            rows = list(csv.DictReader(line for line in file if line.endswith('\n')))
        for row in rows:
            int(row['episode'])
            for column, value in row.items():
                if column not in TEXTS:
                    float(value)  # a row that is too short has None
    except (ValueError, KeyError, TypeError, csv.Error) as error:
        raise ValueError(f'{path} is no table of episodes: {error!r}') from error
    return rows


def _csv(rows: list[list]) -> str:
    text = io.StringIO(newline='')
    csv.writer(text, lineterminator='\n').writerows(
        [[f'{value:.6g}' if isinstance(value, float) else value for value in row] for row in rows])
    return text.getvalue()
