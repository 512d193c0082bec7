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

"""A recorded session that plays."""

import math
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .picture import Picture
from .recording import Recording
from .showing import Showing

CHART_SECONDS = 15
"""How far back the chart of the moments reaches, s."""
TRACE_FOR = 0.5
"""Pictures have it for as long after a jump, s: a page may miss some of them."""
SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)


class ReplayDesk:
    """See :class:`Desk`. All who look at it see the same; whoever has the teacher's seat plays it."""

    is_replay = True
    is_over = is_finished = False

    def __init__(self, recording: Recording, showing: Showing = Showing()):
        self.showing = showing
        self._recording = recording
        self.task = recording.task
        self._position = 0.0
        self._speed = 1.0
        self._plays = False
        self._looked_at = time.monotonic()
        self._trace: list[list[float | None]] = []
        self._jumped_at = -math.inf

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
        if now - self._jumped_at < TRACE_FOR:
            picture.trace = self._trace
        return picture

    def _seek(self, seconds: float) -> None:
        self._position = float(min(max(seconds, 0.0), self._recording.length))

    def _jump(self, seconds: float) -> None:
        """Go there, and have what came before in the charts."""
        self._seek(seconds)
        self._trace = self._recording.trace(self._position, CHART_SECONDS)
        self._jumped_at = time.monotonic()

    def file(self, name: str) -> Path | None:
        """The report is the session's own file."""
        return None

    def press(self, buttons: list[int], axes: Sequence[float] = ()) -> None:
        """Keys mean nothing to a recording."""

    def let_go(self) -> None:
        """Keys mean nothing to a recording."""

    def do(self, command: str, value: Any) -> None:
        """See :class:`Desk`."""
        if command == 'seek' and isinstance(value, int | float) and -math.inf < value < math.inf:
            self._jump(value)  # an integer may be larger than any float
        elif command == 'speed' and value in SPEEDS:
            self._speed = float(value)
        elif command == 'play' and isinstance(value, bool):
            if value and self._position >= self._recording.length:
                self._jump(0.0)
            self._plays = value
        else:
            raise ValueError(f'no command {command!r} with {value!r}')
