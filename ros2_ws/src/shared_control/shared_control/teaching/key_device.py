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

"""Keys and sticks as a device: a press adds a step to a moment that all sources share, a stick adds what it holds."""

from collections.abc import Sequence

import numpy as np

from ..keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, KeyMoment, PressesBySource
from ..sticks import DEAD_BAND, StickMoment
from ..tasks.task import Task


class KeyDevice:
    """The keys of the task as a :class:`Device`: buttons = left, right, space, and up and down if there are any.

    A source that has a stick, too, sends it as axes = left, up (-1..1).

    Args:
        task: which key moves which axis.
        keystroke: of one press, N m.
        limit: bound about each axis, N m; a stick held all the way gives it.
        dead_band: part of a stick's travel that is nothing.
        curve: exponent of what lies beyond.
    """

    def __init__(self, task: Task, keystroke: float = KEYSTROKE, limit: float = HUMAN_MOMENT_LIMIT,
                 dead_band: float = DEAD_BAND, curve: float = 1.0):
        self._limit = limit
        self._moment = KeyMoment(task.keys, keystroke, limit)
        self._presses = PressesBySource()
        self._stick = StickMoment(task.keys, limit, dead_band, curve)
        self._held: dict[str, np.ndarray] = {}

    @property
    def moment(self) -> np.ndarray:
        """See :class:`Device`: as the presses leave it, until the next one, and what sticks are held at."""
        return np.clip(sum(self._held.values(), self._moment.moment), -self._limit, self._limit)

    def update(self, source: str, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """See :class:`Device`. A key that is held down at a :meth:`release` counts when it is pressed again."""
        held = self._stick.of(axes)
        pressed = self._presses.update(source, buttons)
        for key in pressed:
            self._moment.press(key)
        self._held[source] = held
        return bool(pressed) or bool(held.any())

    def forget(self, source: str) -> None:
        """See :class:`Device`."""
        self._presses.forget(source)
        self._held.pop(source, None)

    def release(self) -> None:
        """See :class:`Device`. A stick that is still held counts again with its next state."""
        self._moment.release()
        self._held.clear()
