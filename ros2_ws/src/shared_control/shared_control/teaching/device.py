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

"""What a person holds in the hand: keys, a stick, a knob."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np


class Device(Protocol):
    """Turns the states that its sources send (``sensor_msgs/Joy``) into the human's moment.

    Found by name (entry point of ``shared_control.devices``) and made by ``Device(task, keystroke, limit)``: the task
    with its ``axes`` and ``keys``; what one press of a key adds, N m; the bound about each axis, N m. Several sources
    may move one device (a terminal and a page): they share its moment. ``k`` is the number of the task's axes.
    """

    @property
    def moment(self) -> np.ndarray:
        """The human's moment, (k,), N m, within the limit; zero as long as nobody does anything."""

    def update(self, source: str, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """A state of ``source``, which repeats it at 10 Hz or more: ``axes`` and ``buttons`` of its Joy.

        What rests, with its jitter, is nothing: a dead band is the device's own affair.

        Returns:
            Whether the source did something (pressed a key) or does (holds a stick).

        Raises:
            ValueError: this is no state of such a device; it changes nothing.
        """

    def forget(self, source: str) -> None:
        """``source`` fell silent: what it is known to hold counts no more."""

    def release(self) -> None:
        """Let go: the moment is zero until a source does something."""
