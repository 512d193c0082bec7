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

"""From the bytes a terminal sends to strokes, and from strokes to keys that are down."""

import math
import re
import time
from collections.abc import Collection, Iterable
from enum import Enum


class Stroke(Enum):
    """What a person can ask for in the terminal."""

    LEFT = 'left'
    RIGHT = 'right'
    UP = 'up'
    DOWN = 'down'
    SPACE = 'space'
    START = 'start'
    FINISH = 'finish'
    PAUSE = 'pause'
    REDRAW = 'redraw'
    GOOD = 'good'
    BAD = 'bad'
    DISCARD = 'discard'


PUSHES = (Stroke.LEFT, Stroke.RIGHT, Stroke.UP, Stroke.DOWN, Stroke.SPACE)
"""Strokes that push, or take the push away; the others ask for something."""
_LETTERS = {
    b'a': Stroke.LEFT, b'A': Stroke.LEFT, b'd': Stroke.RIGHT, b'D': Stroke.RIGHT, b' ': Stroke.SPACE,
    b'w': Stroke.UP, b'W': Stroke.UP, b's': Stroke.DOWN, b'S': Stroke.DOWN,
    b'\r': Stroke.START, b'\n': Stroke.START,
    b'q': Stroke.FINISH, b'Q': Stroke.FINISH, b'p': Stroke.PAUSE, b'P': Stroke.PAUSE, b'\x0c': Stroke.REDRAW,
    b'g': Stroke.GOOD, b'G': Stroke.GOOD, b'b': Stroke.BAD, b'B': Stroke.BAD, b'x': Stroke.DISCARD,
    b'X': Stroke.DISCARD}
_ARROWS = {b'A': Stroke.UP, b'B': Stroke.DOWN, b'C': Stroke.RIGHT, b'D': Stroke.LEFT}

# What a terminal sends besides characters (ECMA-48 and xterm). An arrow is ESC [ D, ESC O D (application mode) or, with
# Shift or Ctrl held, ESC [ 1 ; 5 D; all else is passed over as a whole, or its letters would be keys.
_PASTE = rb'\x1b\[200~.*?\x1b\[201~'
_FUNCTION_KEY_OF_THE_CONSOLE = rb'\x1b\[\[[A-E]'
_X10_MOUSE = rb'\x1b\[M.{3}'
_CONTROL_SEQUENCE = rb'\x1b\[[0-?]*[ -/]*[@-~]|\x1bO[0-9;]*[@-~]'
_STRING = rb'\x1b[\]PX^_].*?(?:\x07|\x1b\\)'
_SEQUENCE = re.compile(
    b'|'.join((_PASTE, _FUNCTION_KEY_OF_THE_CONSOLE, _X10_MOUSE, _CONTROL_SEQUENCE, _STRING)), re.DOTALL)
_BEGUN = re.compile(
    rb'\x1b(?:\[(?:200~(?:(?!\x1b\[201~).)*|\[|M.{0,2}|[0-?]*[ -/]*)|O[0-9;]*|[\]PX^_](?:(?!\x07|\x1b\\).)*)?',
    re.DOTALL)
_ARROW = re.compile(rb'\x1b(?:\[(?:1;[0-9]+)?|O[0-9;]*)([A-D])')
_WITHIN = 0.2
"""The rest of a sequence comes within this; what a person types after Escape does not, s."""


class Keyboard:
    """Decodes what is typed; the rest of a sequence may come with the next bytes.

    Args:
        unknown: strokes that mean nothing here.
    """

    def __init__(self, unknown: Collection[Stroke] = (Stroke.UP, Stroke.DOWN)) -> None:
        self._unknown = unknown
        self._rest = b''
        self._read_at = 0.0

    def strokes(self, data: bytes) -> list[Stroke]:
        """The strokes in ``data``, in order. Keys that mean nothing here are passed over."""
        now = time.monotonic()
        if now - self._read_at > _WITHIN:
            self._rest = b''
        if not data:
            return []
        self._read_at = now
        data, self._rest = self._rest + data, b''
        found = []
        position = 0
        while position < len(data):
            if _BEGUN.fullmatch(data, position):
                self._rest = data[position:]
                break
            sequence = _SEQUENCE.match(data, position)
            token = sequence.group() if sequence else data[position:position + 1]
            found.append(_stroke(token))
            position += len(token)
        return [stroke for stroke in found if stroke is not None and stroke not in self._unknown]


def _stroke(token: bytes) -> Stroke | None:
    arrow = _ARROW.fullmatch(token)
    return _ARROWS[arrow[1]] if arrow else _LETTERS.get(token)


class HeldKeys:
    """Tells presses from the repetitions by which a terminal reports a key that is held down.

    A terminal reports no release: a key is down until its strokes have not come for ``REPEATS_WITHIN``. The first
    repetition comes late (0.25 to 0.7 s after the press, as the keyboard is set) and counts as a press.

    Not so for keys that ask for something: held, they would answer their own question, or take back what they said. Of
    these a press soon after the last one counts when the key is up again, unless it went on.

    Args:
        period: at which :meth:`update` is meant to be called, s.
    """

    REPEATS_WITHIN = 0.13
    """Between two repetitions, s: 10 a second on a Linux console, 30 elsewhere. Nobody presses one key so quickly."""

    FIRST_REPETITION_WITHIN = 0.8
    """After the press, s."""

    def __init__(self, period: float) -> None:
        self._longest = 2.0 * period
        self._silent: dict[Stroke, float] = {}
        self._came_at: dict[Stroke, float] = {}
        self._in_doubt: set[Stroke] = set()
        """Those down that are a press unless their strokes go on."""
        self._looked_at = 0.0

    @property
    def down(self) -> Collection[Stroke]:
        """The keys that are down."""
        return self._silent.keys()

    def update(self, strokes: Iterable[Stroke], now: float) -> list[Stroke]:
        """The keys that went down, given the strokes since the last call and the time, s."""
        strokes = list(strokes)
        elapsed = now - self._looked_at
        self._looked_at = now
        # What did not come was silent all the time; what came may have come all the time, if nobody looked for long.
        self._silent = {stroke: silent + (0.0 if stroke in strokes and elapsed > self._longest else elapsed)
                        for stroke, silent in self._silent.items()}
        pressed = []
        for stroke in strokes:
            goes_on = self._silent.get(stroke, self.REPEATS_WITHIN) < self.REPEATS_WITHIN
            if goes_on:
                self._in_doubt.discard(stroke)
            elif stroke not in PUSHES and now - self._came_at.get(stroke, -math.inf) < self.FIRST_REPETITION_WITHIN:
                self._in_doubt.add(stroke)
            else:
                pressed.append(stroke)
            self._silent[stroke], self._came_at[stroke] = 0.0, now
        self._silent = {stroke: silent for stroke, silent in self._silent.items() if silent < self.REPEATS_WITHIN}
        pressed += self._in_doubt - self._silent.keys()
        self._in_doubt &= self._silent.keys()
        return pressed
