"""``episodes.csv``: one row for every episode, written as they end."""

import csv
import io
import os
from pathlib import Path

from shared_control.files import write_atomically

from .episode import Episode

TABLE_NAME = 'episodes.csv'
"""Name of the file in a learner's folder."""


class EpisodeTable:
    """Appends rows, each on disk before the next episode begins.

    Args:
        path: of the file.
        taught: episodes that the learner has learned from. Rows of later ones, left by a run that was killed before
            it saved its learner, are dropped, and so are those of an earlier test and a half-written last line.
    """

    def __init__(self, path: Path, taught: int = 0):
        self._path = path
        rows = [row for row in read_rows(path) if row['phase'] == 'teach' and int(row['episode']) <= taught]
        self._has_header = bool(rows)
        self.taught_seconds = sum(float(row['seconds']) + float(row['learn_seconds']) for row in rows)
        """How long the learner was taught before, s: its episodes by the robot's time, and the time of learning."""
        write_atomically(path, (_csv([list(rows[0])]) + _csv([list(row.values()) for row in rows])).encode()
                         if rows else b'')

    def append(self, episode: Episode) -> None:
        """The row of an episode that has ended."""
        row = episode.row()
        lines = _csv([list(row.values())] if self._has_header else [list(row), list(row.values())])
        with self._path.open('a', newline='') as file:
            file.write(lines)
            file.flush()
            os.fsync(file.fileno())
        self._has_header = True


def read_rows(path: Path) -> list[dict[str, str]]:
    """The complete rows by column name; none when there is no file."""
    if not path.exists():
        return []
    with path.open(newline='') as file:
        return list(csv.DictReader(line for line in file if line.endswith('\n')))


def _csv(rows: list[list]) -> str:
    text = io.StringIO(newline='')
    csv.writer(text, lineterminator='\n').writerows(
        [[f'{value:.6g}' if isinstance(value, float) else value for value in row] for row in rows])
    return text.getvalue()
