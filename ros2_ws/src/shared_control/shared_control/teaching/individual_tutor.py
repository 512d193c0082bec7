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

"""One simulated person at the keys: eyes, hands, habits, and the law by which they steer."""

import math
from collections import deque

import numpy as np

from ..keys import Key
from ..tasks.balance import BALANCE
from ..tasks.task import Task
from .individual import Individual
from .laws import BangBang, Blind, Contrary, Crossover, Intermittent, Law, Reactive, Surge
from .person import ROUNDING, SimulatedPerson, in_keystrokes, key_towards
from .picture import Picture

DRIFT_SECONDS = 4.0
"""How long a slow or a quick spell of reactions lasts, s."""
NOISE_SECONDS = 0.3
"""How long an error of perception lasts, s."""
TRUST_SECONDS = 4.0
"""How long a ball must have been where it should be until a person has come to leave it to the robot, s."""
TRUSTED_WITHIN = 0.03
"""m: so near is where it should be, to a person who watches whether the robot can do without."""
TRUSTED_DEAD_BAND = 3.0
"""How many times as far from there the ball may be before a person helps who trusts the robot fully."""


class IndividualTutor(SimulatedPerson):
    """An :class:`Individual` at the keys.

    Args:
        individual: who it is.
        seed: of everything that differs from look to look and from press to press.
        episodes: taught before.
        task: its axes and keys.
    """

    def __init__(self, individual: Individual, seed: int = 0, episodes: int = 0, task: Task = BALANCE):
        self.individual = individual
        super().__init__(task, seed, episodes)

    def _begin(self) -> None:
        who, episode = self.individual, max(self._episodes, 1)
        novice = max(0.0, 1.0 - (episode - 1) / who.learns_within) if who.learns_within else 0.0
        self._tired = 1.0 + who.fatigue * (episode - 1)
        self._delay = who.delay * (1.0 + novice) * self._tired
        self._wrong_keys = min(who.wrong_keys * (1.0 + novice), 1.0)
        self._law = _law(who, self._random)
        self._trust = 0.0
        self._seen: deque[tuple[float, Picture]] = deque()
        self._error = np.zeros((2, len(self._task.axes)))
        self._drift = 0.0
        self._seconds = 0.0
        self._may_press_at = self._inattentive_until = 0.0
        self._pressed_at = -math.inf
        self._forgotten: np.ndarray | None = None

    def wanted(self, seconds: float, picture: Picture, held: np.ndarray) -> np.ndarray | None:
        """The moment that the hand should hold, (k,), N m; None: as it is. For the arguments see :meth:`key`."""
        elapsed = seconds - self._seconds if self._seen else 0.0
        self._seconds = seconds
        self._seen.append((seconds, self._blurred(picture, elapsed)))
        seen, delay = self._late(seconds, elapsed)
        self._judge(seen, elapsed)
        if delay is None or self._is_inattentive(seconds, elapsed):
            return None
        return self._law.wanted(seconds, self._as_trusted(seen), delay, held)

    def key(self, seconds: float, picture: Picture, held: np.ndarray) -> Key | None:
        """See :class:`SimulatedPerson`."""
        aim = self.wanted(seconds, picture, held)
        if aim is None:
            return None
        wanted = self._habit(seconds, in_keystrokes(aim), held)
        if seconds < self._may_press_at:
            return None
        key = key_towards(wanted, held, self._task.keys)
        if key is not None:
            self._may_press_at = seconds + 1.0 / self.individual.key_rate - ROUNDING
            self._pressed_at = seconds
            if self._random.random() < self._wrong_keys:
                others = [other for other in (*self._task.keys, Key.SPACE) if other is not key]
                key = others[self._random.integers(len(others))]
        return key

    def _blurred(self, picture: Picture, elapsed: float) -> Picture:
        kept = math.exp(-elapsed / NOISE_SECONDS)
        sizes = np.array([[self.individual.position_noise], [self.individual.velocity_noise]])
        self._error = kept * self._error + math.sqrt(1.0 - kept**2) * sizes * self._random.standard_normal(
            self._error.shape)
        return Picture(picture.position_error + self._error[0], picture.velocity + self._error[1], picture.tilt)

    def _late(self, seconds: float, elapsed: float) -> tuple[Picture, float | None]:
        """What was to see a reaction time ago, and how long that is; None: nothing yet.

        The delay is log-normal: half of its spread drifts slowly, half differs from look to look.
        """
        kept = math.exp(-elapsed / DRIFT_SECONDS)
        self._drift = kept * self._drift + math.sqrt(1.0 - kept**2) * float(self._random.standard_normal())
        z = (self._drift + float(self._random.standard_normal())) / math.sqrt(2.0)
        latest = seconds - self._delay * math.exp(self.individual.delay_spread * z) + ROUNDING
        longest = seconds - self._delay * math.exp(3.0 * self.individual.delay_spread)
        while len(self._seen) > 1 and self._seen[1][0] <= longest:
            self._seen.popleft()
        known = [entry for entry in self._seen if entry[0] <= latest]
        if not known:
            return self._seen[0][1], None
        at, seen = known[-1]
        return seen, seconds - at

    def _judge(self, seen: Picture, elapsed: float) -> None:
        """Come to trust a robot under which the ball stays where it should be."""
        well = float(np.abs(seen.position_error).max() < TRUSTED_WITHIN)
        self._trust += (well - self._trust) * min(elapsed / TRUST_SECONDS, 1.0)

    def _as_trusted(self, seen: Picture) -> Picture:
        """What is seen; nothing amiss in it, when the person leaves that to the robot."""
        if not self.individual.hands_over:
            return seen
        left = max(self.individual.dead_band, 0.01) * TRUSTED_DEAD_BAND * self._trust
        if float(np.abs(seen.position_error).max()) >= left:
            return seen
        return Picture(np.zeros_like(seen.position_error), np.zeros_like(seen.velocity), seen.tilt)

    def _is_inattentive(self, seconds: float, elapsed: float) -> bool:
        if seconds >= self._inattentive_until:
            lapse = self._random.random() < self.individual.lapses / 60.0 * self._tired * elapsed
            if lapse:
                self._inattentive_until = seconds + float(self._random.exponential(self.individual.lapse_seconds))
        return seconds < self._inattentive_until

    def _habit(self, seconds: float, wanted: np.ndarray, held: np.ndarray) -> np.ndarray:
        """What the hand makes of what is wanted."""
        who = self.individual
        if who.habit == 'tap' and held.any() and seconds - self._pressed_at >= who.tap_seconds:
            return np.zeros_like(wanted)
        if who.habit == 'forget' and held.any() and not wanted.any():
            if self._forgotten is None or not np.array_equal(self._forgotten, held):
                self._forgotten = held if self._random.random() < who.forgets else None
            return held if self._forgotten is not None else wanted
        self._forgotten = None
        return wanted


def _law(who: Individual, random: np.random.Generator) -> Law:
    """The law of an individual, fresh for an episode."""
    damping = who.stiffness * who.lead
    if who.law == 'crossover':
        return Crossover(who.stiffness, who.lead, lag=0.15, remnant=0.3, dead_band=who.dead_band, random=random)
    if who.law == 'intermittent':
        return Intermittent(who.stiffness, damping, who.dead_band, who.rhythm)
    if who.law in ('bang_bang', 'opposed'):
        bang_bang = BangBang(who.lead, who.dead_band, who.strength)
        return bang_bang if who.law == 'bang_bang' else Contrary(bang_bang)
    if who.law == 'surge':
        return Surge(who.strength * 4.0, who.rhythm, who.dead_band, who.lead)
    if who.law == 'blind':
        return Blind(1.0 / who.rhythm, random)
    reactive = Reactive(who.stiffness, damping, who.dead_band)
    return Contrary(reactive) if who.law == 'contrary' else reactive
