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

"""What a bag holds, as arrays.

``received_ns`` is the wall clock of the recorder, ns, running on where it was set back between two files of the bag;
``stamp_ns`` is the robot's time (simulation time when it is simulated), ns. Rows are in the order in which they were
received.
"""

import math
from dataclasses import dataclass

import numpy as np
from shared_control.keys import Key
from shared_control.verdict import Verdict


@dataclass(frozen=True, eq=False)
class Ticks:
    """What is kept of every single /joint_states; a tick that nobody answered may appear again."""

    received_ns: np.ndarray
    """(n,)"""
    stamp_ns: np.ndarray
    """(n,)"""
    at_rest: np.ndarray
    """(n,), bool: no joint moves, as at the first tick of an episode."""
    effort: np.ndarray
    """(n,): digests of the torques that were applied last."""


@dataclass(frozen=True, eq=False)
class JointStates:
    """The first /joint_states of every 10 ms, those of /ball; all of them when that was asked for."""

    received_ns: np.ndarray
    """(n,)"""
    stamp_ns: np.ndarray
    """(n,)"""
    q: np.ndarray
    """(n, joints), rad"""
    qd: np.ndarray
    """(n, joints), rad/s"""
    effort: np.ndarray
    """(n, joints), N m: what was applied last."""


@dataclass(frozen=True, eq=False)
class Commands:
    """/effort_controller/commands."""

    received_ns: np.ndarray
    """(n,)"""
    torque: np.ndarray
    """(n,): digests of the torques."""


@dataclass(frozen=True, eq=False)
class Wrenches:
    """A wrench topic, in the base frame."""

    received_ns: np.ndarray
    """(n,)"""
    stamp_ns: np.ndarray
    """(n,)"""
    moment: np.ndarray
    """Along the task's axes, (n, k), N m"""

    def between(self, window: tuple[int, int]) -> 'Wrenches':
        """Those received in a window of the recorder's time, in the order of their stamps."""
        rows = slice(*np.searchsorted(self.received_ns, window))
        found = Wrenches(self.received_ns[rows], self.stamp_ns[rows], self.moment[rows])
        if (np.diff(found.stamp_ns) >= 0).all():
            return found
        order = np.argsort(found.stamp_ns, kind='stable')
        return Wrenches(found.received_ns[order], found.stamp_ns[order], found.moment[order])

    def moment_at(self, stamps_ns: np.ndarray) -> np.ndarray:
        """The newest moment at each of some times of the robot, (m, k), N m; the first one before that.

        There must be one.
        """
        return self.moment[(np.searchsorted(self.stamp_ns, stamps_ns, 'right') - 1).clip(min=0)]


@dataclass(frozen=True, eq=False)
class BallTrack:
    """/ball, in the base frame."""

    received_ns: np.ndarray
    """(n,)"""
    stamp_ns: np.ndarray
    """(n,)"""
    position: np.ndarray
    """(n, 3), m"""
    velocity: np.ndarray
    """(n, 3), m/s"""


@dataclass(frozen=True, eq=False)
class Series:
    """A topic of one number or text, such as those under /training."""

    received_ns: np.ndarray
    """(n,)"""
    values: np.ndarray
    """(n,)"""


@dataclass(frozen=True)
class Press:
    """One key press."""

    received_ns: int
    source: str
    key: Key


@dataclass(frozen=True)
class Judgement:
    """What a person has said of an episode, or taken back."""

    received_ns: int
    episode: str
    """As ``episode_key`` names it."""
    verdict: Verdict


@dataclass(frozen=True)
class Status:
    """One report of a node on /diagnostics."""

    received_ns: int
    ok: bool
    message: str
    values: dict[str, str]

    def number(self, key: str) -> float | None:
        """One of the values as a number; None when there is none, or none that is finite."""
        try:
            value = float(self.values[key])
        except (KeyError, ValueError):
            return None
        return value if math.isfinite(value) else None
