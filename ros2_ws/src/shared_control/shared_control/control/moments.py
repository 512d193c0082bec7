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

"""What becomes of the moments of human and agent before they reach the arm."""

import numpy as np

from ..bounds import bounded

FADE_TIME = 0.1
"""How long the moment of a silent source takes to fade to nothing, s."""


def freshness(age: float, timeout: float) -> float:
    """The part of a command of a given age (s) that still counts.

    1 up to ``timeout`` (s), then falling to 0 within ``FADE_TIME``: a source that vanishes neither latches nor jerks.
    0 for a command whose stamp is further ahead than ``timeout``: time has been set back, and the source has not sent
    anything since.
    """
    if age < -timeout:
        return 0.0
    return min(max(1.0 - (age - timeout) / FADE_TIME, 0.0), 1.0)


def sum_moments(agent: np.ndarray, human: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """The sum of both moments (3.3), each axis kept within ``limit``; all (k,), N m."""
    return bounded(agent + human, limit)


class MomentSource:
    """The last moment that one source (human or agent) sent, and when.

    Args:
        size: number of the task's axes, k.
        timeout: age after which it is stale, s.
    """

    def __init__(self, size: int, timeout: float):
        self.moment = np.zeros(size)
        """(k,), N m"""
        self.stamp_ns = 0
        """0 before the first one, and after one was forgotten."""
        self._timeout = timeout
        self._now_ns = 0

    def take(self, moment: np.ndarray, stamp_ns: int) -> None:
        """The source sent a moment, (k,), N m."""
        self.moment, self.stamp_ns = moment, stamp_ns

    def follow(self, now_ns: int) -> None:
        """Forget what was sent before the robot's time ran back: it would count again once that time has come.

        To be called before :meth:`take`, so that what comes at ``now_ns`` is not forgotten with it.
        """
        if now_ns < self._now_ns or self.age(now_ns) < -self._timeout:
            self.take(np.zeros_like(self.moment), 0)
        self._now_ns = now_ns

    def age(self, now_ns: int) -> float:
        """How old it is at ``now_ns``, s; negative when its stamp is ahead."""
        return (now_ns - self.stamp_ns) * 1e-9

    def at(self, now_ns: int) -> np.ndarray:
        """The moment that counts at ``now_ns``, (k,), N m: see :func:`freshness`."""
        self.follow(now_ns)
        return self.moment * freshness(self.age(now_ns), self._timeout)
