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

"""From the states of several sources to one moment of the human."""

from collections.abc import Sequence

import numpy as np
from shared_control.teaching.device import Device

REMEMBERED = 20
"""So many sources are remembered where silent ones are not forgotten: whoever makes up names fills no memory."""
_WHILE_TIME_STANDS = 4.0
"""A source is silent after so many timeouts by the monotonic clock, too: the robot's time may stand still. After one, a
machine that is held up for a moment would take a person's push away."""


class Sources:
    """Hears any number of sources of a device; none of them can leave a moment behind.

    Args:
        device: what turns their states into the moment.
        timeout: a source that did something and is silent for longer takes the moment with it, s of the robot's time.
    """

    def __init__(self, device: Device, timeout: float):
        self._device = device
        self._size = len(device.moment)
        self._timeout_ns = round(timeout * 1e9)
        self._timeout = timeout
        self._heard: dict[str, tuple[int, float]] = {}
        """When, by the robot's time, ns, and by the monotonic clock, s."""
        self._acting: set[str] = set()
        """Whoever did something in their last state. What they do may be as much as another does the other way."""
        self._holding: set[str] = set()
        self._is_active = True
        self.last_pressed = ''
        """The source that last did something."""

    @property
    def moment(self) -> np.ndarray:
        """The human's moment, (k,), N m."""
        return self._device.moment

    @property
    def is_active(self) -> bool:
        """Whether the device counts. The moment is zero while it does not."""
        return self._is_active

    @is_active.setter
    def is_active(self, active: bool) -> None:
        self._is_active = active
        if not active:
            self.release()

    def hear(self, source: str, axes: Sequence[float], buttons: Sequence[int], now_ns: int, now: float) -> None:
        """The state of one source, heard at ``now_ns`` of the robot's time and ``now`` of the monotonic clock, s.

        Raises:
            ValueError: this is no state of the device.
        """
        acts = self._device.update(source, axes, buttons)
        self._heard[source] = now_ns, now
        if not self._is_active:
            self._device.release()
            return
        moment = self._device.moment
        if len(moment) != self._size or not np.isfinite(moment).all():  # somebody else's code
            self.release()
            raise ValueError(f'the device makes {moment} N m of it')
        if acts:
            self._acting.add(source)
            self._holding.add(source)
            self.last_pressed = source
        else:
            self._acting.discard(source)
        if not self._acting and not moment.any():
            self._holding.clear()

    def drop_silent(self, now_ns: int, now: float) -> list[str]:
        """Forget the sources that fell silent; the names of those whose moment was thereby set to zero.

        A clock that jumped back (a simulator started anew) makes every source silent.
        """
        silent = [name for name, (heard_ns, heard) in self._heard.items()
                  if not 0 <= now_ns - heard_ns <= self._timeout_ns or now - heard > _WHILE_TIME_STANDS * self._timeout]
        gone = [name for name in silent if name in self._holding]
        for name in silent:
            self.leave(name)
        return gone

    def leave(self, source: str) -> None:
        """Nobody is at a source any more: it is forgotten, and the moment is zero if it may have held some of it."""
        self._heard.pop(source, None)
        self._acting.discard(source)
        self._device.forget(source)
        if source in self._holding or not self._heard:
            self.release()

    def release(self) -> None:
        """Let go of the device: no moment."""
        self._device.release()
        self._acting.clear()
        self._holding.clear()
