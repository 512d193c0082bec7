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

"""What is kept of the 1 kHz topics of a bag: a session of 45 minutes has 2.7 million ticks."""

import numpy as np

from .fast_decode import Columns, Row

EVERY_NS = 10_000_000
"""How often joint states are kept: as often as /ball is published."""


class JointStateRows:
    """Takes every /joint_states as it is decoded, and keeps of it what a long session has room for.

    Args:
        every_tick: keep all joint states (180 bytes each), not those of every 10 ms alone.
    """

    def __init__(self, every_tick: bool):
        self._every_tick = every_tick
        self._slot = -1
        self.ticks = Columns()
        self.states = Columns()

    def add(self, times: np.ndarray, columns: Row) -> None:
        """A block: times of receipt, ns; stamp as (s, ns), q, qd, effort."""
        stamp, q, qd, effort = columns
        stamps = to_ns(stamp)
        self.ticks.add(times, (stamps, (qd == 0.0).all(axis=1), digests(effort)))
        slots = stamps // EVERY_NS
        kept = slice(None) if self._every_tick else np.flatnonzero(np.diff(slots, prepend=self._slot))
        self._slot = slots[-1]
        self.states.add(times[kept], (stamps[kept], q[kept], qd[kept], effort[kept]))


def to_ns(stamp: np.ndarray) -> np.ndarray:
    """Stamps of (n, 2) seconds and nanoseconds, (n,), ns."""
    return stamp.astype(np.int64) @ np.array([1_000_000_000, 1])


def digests(rows: np.ndarray) -> np.ndarray:
    """A number for each row of numbers, (n, k), the same for rows that are equal: (n,), uint64.

    Of two million rows, two different ones have the same with a probability of 1e-7.
    """
    words = np.ascontiguousarray(rows + 0.0).view(np.uint64).reshape(rows.shape)  # + 0.0 makes -0.0 the same as 0.0
    result = np.zeros(len(words), np.uint64)
    for column in words.T:  # the finalizer of MurmurHash3 (Appleby, 2008)
        result ^= column
        for factor in (0xff51afd7ed558ccd, 0xc4ceb9fe1a85ec53):
            result ^= result >> np.uint64(33)
            result *= np.uint64(factor)
        result ^= result >> np.uint64(33)
    return result
