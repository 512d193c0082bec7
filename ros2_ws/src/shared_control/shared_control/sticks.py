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

"""From the axes of a gamepad, a space mouse, a pedal or a finger on the page to a moment."""

from collections.abc import Sequence

import numpy as np

from .keys import HUMAN_MOMENT_LIMIT, LEFT_AND_RIGHT, Key, KeyMap

DEAD_BAND = 0.1
"""Part of a stick's travel, around its middle, that is nothing: sticks at rest tremble, and do not return exactly."""
DIRECTIONS = (Key.LEFT, Key.UP)
"""What the axes of a state mean when they are positive."""


class StickMoment:
    """The moment of a stick: as far as it is held, so large. A stick to the left means what the left key means.

    Args:
        keys: which key moves which axis, and which way.
        limit: the moment about each axis with the stick held all the way, N m.
        dead_band: part of the travel that is nothing, 0 <= dead_band < 1.
        curve: exponent of what lies beyond; above 1 makes small moments finer.
    """

    def __init__(self, keys: KeyMap = LEFT_AND_RIGHT, limit: float = HUMAN_MOMENT_LIMIT, dead_band: float = DEAD_BAND,
                 curve: float = 1.0):
        self._axes = [(number, *keys[key]) for number, key in enumerate(DIRECTIONS) if key in keys]
        self._size = 1 + max(axis for axis, _ in keys.values())
        self._limit, self._dead_band, self._curve = limit, dead_band, curve

    def of(self, axes: Sequence[float]) -> np.ndarray:
        """The moment of a state, (k,), N m.

        Args:
            axes: to the left and up (away from the person), -1..1; what is missing is 0, what there is besides is not
                looked at.

        Raises:
            ValueError: a value is not within -1..1.
        """
        values = list(axes[:len(DIRECTIONS)])
        if not all(-1.0 <= value <= 1.0 for value in values):  # nan as well
            raise ValueError(f'expected axes of -1 to 1 (left, up), got {values}')
        moment = np.zeros(self._size)
        for number, axis, sign in self._axes:
            if number < len(values):
                moment[axis] += sign * self._limit * self._shaped(values[number])
        return moment

    def _shaped(self, value: float) -> float:
        beyond = max(abs(value) - self._dead_band, 0.0) / (1.0 - self._dead_band)
        return float(np.copysign(beyond ** self._curve, value))


class JoyMapping:
    """Which of a Joy's axes and buttons are which: makes states of ``/human/keys`` of them.

    Args:
        buttons: numbers of the buttons that are left, right, space, up, down; negative: there is none.
        axes: numbers of the axes that are left-right and up-down; negative: there is none.
        scale: of each of these axes; negative turns it round (positive is left, and up).
        rest: what each of them reads with nobody at it (a pedal's is -1 or 1).

    Raises:
        ValueError: a list has a wrong length or a number that cannot be; the message says which.
    """

    def __init__(self, buttons: Sequence[int] = tuple(range(len(Key))), axes: Sequence[int] = (0, 1),
                 scale: Sequence[float] = (1.0, 1.0), rest: Sequence[float] = (0.0, 0.0)):
        for name, values, count in (('buttons', buttons, len(Key)), ('axes', axes, len(DIRECTIONS)),
                                    ('scale', scale, len(DIRECTIONS)), ('rest', rest, len(DIRECTIONS))):
            if len(values) != count or not np.isfinite(values).all():
                raise ValueError(f'{name} is {list(values)}, expected {count} numbers')
        self._buttons, self._axes, self._scale, self._rest = buttons, axes, scale, rest

    def axes(self, axes: Sequence[float]) -> list[float]:
        """To the left and up, -1..1; an axis that is not there is 0.

        Raises:
            ValueError: one of them is not finite: a driver that has lost its device.
        """
        if not np.isfinite([axes[number] for number in self._axes if 0 <= number < len(axes)]).all():
            raise ValueError(f'expected finite axes, got {list(axes)}')
        return [float(np.clip(scale * (axes[number] - rest), -1.0, 1.0)) if 0 <= number < len(axes) else 0.0
                for number, scale, rest in zip(self._axes, self._scale, self._rest, strict=True)]

    def buttons(self, buttons: Sequence[int]) -> list[int]:
        """Left, right, space, up, down, then the Joy's own buttons that have higher numbers, as they are."""
        keys = [int(buttons[number]) if 0 <= number < len(buttons) else 0 for number in self._buttons]
        return keys + [int(button) for button in buttons[len(Key):]]
