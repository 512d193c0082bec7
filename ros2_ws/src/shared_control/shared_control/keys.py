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

"""From key presses to the human's moment (3.4)."""

from collections.abc import Mapping, Sequence
from enum import IntEnum

import numpy as np

KEYSTROKE = 5.0
"""N m a press: 0.05 of the action times 100 N m (3.4 and appendix)."""

HUMAN_MOMENT_LIMIT = 10.0
"""Bound of the human's moment about each axis, N m."""

TERMINAL, PAGE, TUTOR = OUR_SOURCES = ('terminal', 'page', 'tutor')
"""Names of the sources of keys that are parts of the graph themselves; the tutor is simulated."""

COUNT_IN = ('practice', 'teach')
"""The phases of a lesson in which keys count; they also do where nobody gives one."""


class Key(IntEnum):
    """The keys; the value is the button's index in ``/human/keys``. Up and down are for tasks with two axes."""

    LEFT = 0
    RIGHT = 1
    SPACE = 2
    UP = 3
    DOWN = 4


KeyMap = Mapping[Key, tuple[int, float]]
"""Which of a task's axes (index) a key moves, and which way (1 or -1). Space lets go of all."""

LEFT_AND_RIGHT: KeyMap = {Key.LEFT: (0, 1.0), Key.RIGHT: (0, -1.0)}
"""One axis. Left is positive: for a moment about base y the tray's +x side tips down, and the ball rolls to +x, the
left of every picture."""


class KeyMoment:
    """The human's moment as the keys leave it: a key adds a step about its axis, space sets zero.

    Args:
        keys: which key moves which axis.
        step: of one press, N m.
        limit: bound about each axis, N m.
    """

    def __init__(self, keys: KeyMap = LEFT_AND_RIGHT, step: float = KEYSTROKE, limit: float = HUMAN_MOMENT_LIMIT):
        self._keys = keys
        self._step = step
        self._limit = limit
        self.moment = np.zeros(1 + max(axis for axis, _ in keys.values()))
        """(k,), N m"""

    def press(self, key: Key) -> None:
        """One press; a key that moves no axis does nothing."""
        if key is Key.SPACE:
            self.release()
        elif key in self._keys:
            axis, sign = self._keys[key]
            moment = self.moment.copy()
            moment[axis] = min(max(moment[axis] + sign * self._step, -self._limit), self._limit)
            self.moment = moment

    def release(self) -> None:
        """The person is gone: zero."""
        self.moment = np.zeros_like(self.moment)


BUTTONS = 3
"""Buttons that every source of keys has: left, right, space."""
MAX_SOURCES = 100
"""Sources of keys that are told apart."""


def count_buttons(keys: KeyMap) -> int:
    """How many buttons a source of ``keys`` sends: left, right, space, and all up to the last that is used."""
    return max(BUTTONS, *(key + 1 for key in keys))


def has_let_go(axes: Sequence[float], buttons: Sequence[int]) -> bool:
    """Whether a state on ``/human/keys`` says that nobody is at its source any more: there is nothing in it."""
    return len(axes) == 0 == len(buttons)


class KeyPresses:
    """Finds presses (rising edges) in the button states that one source of keys repeats."""

    def __init__(self) -> None:
        self._down = [False] * len(Key)

    def update(self, buttons: Sequence[int]) -> list[Key]:
        """The keys that went down since the last state.

        Raises:
            ValueError: fewer than three buttons, or a button that is neither 0 nor 1.
        """
        if len(buttons) < BUTTONS:
            raise ValueError(f'expected {BUTTONS} buttons (left, right, space) or more, got {len(buttons)}')
        known = list(buttons[:len(Key)])
        if any(button not in (0, 1) for button in known):
            raise ValueError(f'expected buttons of 0 or 1 (left, right, space, up, down), got {known}')
        down = [bool(button) for button in known] + [False] * (len(Key) - len(known))
        pressed = [key for key in Key if down[key] and not self._down[key]]
        self._down = down
        return pressed


class PressesBySource:
    """:class:`KeyPresses` for each source of keys, of those heard last: anybody may send under any name."""

    def __init__(self) -> None:
        self._sources: dict[str, KeyPresses] = {}

    def update(self, source: str, buttons: Sequence[int]) -> list[Key]:
        """See :meth:`KeyPresses.update`."""
        presses = self._sources.get(source) or KeyPresses()
        pressed = presses.update(buttons)
        self._sources.pop(source, None)
        self._sources[source] = presses  # the one heard last is last
        if len(self._sources) > MAX_SOURCES:
            del self._sources[next(iter(self._sources))]
        return pressed

    def forget(self, source: str) -> None:
        """A source is gone: a key that is down in its next state was pressed."""
        self._sources.pop(source, None)
