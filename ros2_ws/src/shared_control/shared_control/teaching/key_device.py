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

"""Keys as a device: each press adds a step to a moment that all sources share."""

from collections.abc import Sequence

import numpy as np

from ..keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, KeyMoment, KeyPresses
from ..tasks.task import Task


class KeyDevice:
    """The keys of the task as a :class:`Device`: buttons = left, right, space, and up and down if there are any.

    Args:
        task: which key moves which axis.
        keystroke: of one press, N m.
        limit: bound about each axis, N m.
    """

    def __init__(self, task: Task, keystroke: float = KEYSTROKE, limit: float = HUMAN_MOMENT_LIMIT):
        self._moment = KeyMoment(task.keys, keystroke, limit)
        self._presses: dict[str, KeyPresses] = {}

    @property
    def moment(self) -> np.ndarray:
        """See :class:`Device`: as the presses leave it, until the next one."""
        return self._moment.moment

    def update(self, source: str, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """See :class:`Device`. A key that is held down at a :meth:`release` counts when it is pressed again."""
        pressed = self._presses.setdefault(source, KeyPresses()).update(buttons)
        for key in pressed:
            self._moment.press(key)
        return bool(pressed)

    def forget(self, source: str) -> None:
        """See :class:`Device`."""
        self._presses.pop(source, None)

    def release(self) -> None:
        """See :class:`Device`."""
        self._moment.release()
