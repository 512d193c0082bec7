"""One line for every finished episode, for those who see no screen."""

import csv
from collections.abc import Callable
from pathlib import Path


class EpisodePrinter:
    """Reads the agent's table of episodes as it grows.

    Args:
        path: ``episodes.csv``; it may not exist yet.
        say: told of each new episode.
    """

    def __init__(self, path: Path, say: Callable[[str], None]):
        self._path = path
        self._say = say
        self._told = sum(1 for _ in self._rows())

    def poll(self) -> None:
        """Tell what is new."""
        for row in list(self._rows())[self._told:]:
            self._told += 1
            self._say(
                f'{row["phase"]:>5} {int(row["episode"]):3d}: return {float(row["return"]):8.1f}, '
                f'human share {float(row["human_share"]):4.0%}'
                + (', the ball fell' if int(row['fallen']) else
                   f', at the end {1e3 * float(row["settled_position_error"]):5.1f} mm from the centre'))

    def _rows(self) -> list[dict[str, str]]:
        if not self._path.exists():
            return []
        with self._path.open(newline='') as file:
            # The last line may be half written.
            complete = [line for line in file if line.endswith('\n')]
        return list(csv.DictReader(complete))
