"""A recorded session that plays."""

import math
import time
from typing import Any

from .picture import Picture
from .recording import Recording

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)


class ReplayDesk:
    """See :class:`Desk`. All who look at it see the same; whoever has the teacher's seat plays it."""

    is_replay = True
    is_over = False

    def __init__(self, recording: Recording):
        self._recording = recording
        self.task = recording.task
        self._position = 0.0
        self._speed = 1.0
        self._plays = False
        self._looked_at = time.monotonic()

    def look(self) -> Picture:
        """See :class:`Desk`."""
        now = time.monotonic()
        if self._plays:
            self._seek(self._position + self._speed * (now - self._looked_at))
            self._plays = self._position < self._recording.length
        self._looked_at = now
        picture = self._recording.picture(self._position)
        picture.replay = {'position': round(self._position, 2), 'length': round(self._recording.length, 2),
                          'speed': self._speed, 'plays': self._plays}
        return picture

    def _seek(self, seconds: float) -> None:
        self._position = min(max(seconds, 0.0), self._recording.length)

    def press(self, buttons: list[int]) -> None:
        """Keys mean nothing to a recording."""

    def let_go(self) -> None:
        """Keys mean nothing to a recording."""

    def do(self, command: str, value: Any) -> None:
        """See :class:`Desk`."""
        if command == 'seek' and isinstance(value, int | float) and math.isfinite(value):
            self._seek(float(value))
        elif command == 'speed' and value in SPEEDS:
            self._speed = float(value)
        elif command == 'play' and isinstance(value, bool):
            if value and self._position >= self._recording.length:
                self._position = 0.0
            self._plays = value
        else:
            raise ValueError(f'no command {command!r} with {value!r}')
