"""A line for every finished episode and for the page's address, for those who see no screen."""

import re
from collections.abc import Callable
from pathlib import Path

from shared_control_learning.episode_table import read_rows


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
        for row in read_rows(self._path)[self._told:]:
            self._told += 1
            self._say(
                f'{row["phase"]:>5} {int(row["episode"]):3d}: return {float(row["return"]):8.1f}, '
                f'human share {float(row["human_share"]):4.0%}'
                + (', the ball fell' if int(row['fallen']) else
                   f', at the end {1e3 * float(row["settled_position_error"]):5.1f} mm from the centre'))


class AddressPrinter:
    """Looks in the log of the page's node for the address at which it serves.

    Args:
        path: the log; it may not exist. What it holds already is of an earlier run.
        say: told of the address, and of a new one when it changes.
    """

    def __init__(self, path: Path, say: Callable[[str], None]):
        self._path = path
        self._say = say
        self._begin = path.stat().st_size if path.exists() else 0
        self._address = ''

    def poll(self) -> None:
        """Tell it when it is new."""
        text = self._path.read_bytes()[self._begin:] if self._path.exists() else b''
        found = re.findall(r'open (http\S+)', text.decode(errors='replace'))
        if found and found[-1] != self._address:
            self._address = found[-1]
            self._say(f'\n    Teach here: {self._address}\n')
