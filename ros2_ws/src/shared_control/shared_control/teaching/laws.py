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

"""What moment a simulated person wants: laws of manual control, by the strategies that the literature describes.

A law gets a :class:`Picture` (late and inexact), works along each of the task's axes alike, and gives the moment that
the keys should hold, in whole keystrokes. It knows nothing of the robot: whoever follows one of these adds to what the
robot does, as a person does who looks at the ball alone.
"""

from typing import Protocol

import numpy as np

from ..bounds import bounded
from ..keys import HUMAN_MOMENT_LIMIT, KEYSTROKE
from .picture import Picture
from .tutor import BALL_ACCELERATION, TILT_OF_MOMENT, TILT_WANTED_MAX


class Law(Protocol):
    """One strategy, in one episode. ``k`` is the number of the task's axes."""

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """The moment that the hand should hold, (k,), N m.

        Args:
            seconds: now, s.
            seen: what was to see ``delay`` s ago.
            delay: s.
            held: the moment that the hand holds now, (k,), N m.
        """


def _moment(tilt: np.ndarray) -> np.ndarray:
    return bounded(tilt, TILT_WANTED_MAX) / TILT_OF_MOMENT


class Reactive:
    """A spring and a damper on what is seen, outside a dead band: compensation without any prediction.

    Args:
        stiffness: tilt for each metre off, rad/m.
        damping: tilt against each m/s, rad s/m.
        dead_band: m; nearer, nothing is done.
    """

    def __init__(self, stiffness: float, damping: float, dead_band: float):
        self._stiffness, self._damping, self._dead_band = stiffness, damping, dead_band

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        tilt = self._stiffness * seen.position_error - self._damping * seen.velocity
        return np.where(np.abs(seen.position_error) < self._dead_band, 0.0, _moment(tilt))


class Crossover:
    """McRuer and Jex (1967): near crossover, person and plant together are ``w_c exp(-s d) / s``.

    Before a ball on a tray, a double integrator, a person has to lead: ``K (e + T_L de/dt)`` with ``K`` for the
    crossover frequency, behind a neuromuscular lag. The remnant is noise in proportion to the error.

    Args:
        crossover: w_c, rad/s.
        lead: T_L, s.
        lag: of the hand, s.
        remnant: standard deviation of the noise, in parts of what is wanted.
        dead_band: m.
        random: of the remnant.
    """

    def __init__(self, crossover: float, lead: float, lag: float, remnant: float, dead_band: float,
                 random: np.random.Generator):
        self._stiffness = crossover**2 / (BALL_ACCELERATION * np.hypot(1.0, crossover * lead))
        self._lead, self._lag, self._remnant, self._dead_band = lead, lag, remnant, dead_band
        self._random = random
        self._tilt: np.ndarray | None = None
        self._seconds = 0.0

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        aim = self._stiffness * (seen.position_error - self._lead * seen.velocity)
        aim = aim * (1.0 + self._remnant * self._random.standard_normal(aim.shape))
        before = np.zeros_like(aim) if self._tilt is None else self._tilt
        kept = np.exp(-max(seconds - self._seconds, 0.0) / self._lag)
        self._seconds, self._tilt = seconds, kept * before + (1.0 - kept) * aim
        return np.where(np.abs(seen.position_error) < self._dead_band, 0.0, _moment(self._tilt))


class Intermittent:
    """Gawthrop, Loram, Lakie and Gollee (2011): predictive control that acts on events, ballistic in between.

    At an event the state is predicted over the delay, and the tilt that its feedback wants is held. The next event
    comes when what is seen has left what was expected by a threshold, and no sooner than a refractory time later.

    Args:
        stiffness, damping: see :class:`Reactive`.
        threshold: m.
        refractory: s.
    """

    def __init__(self, stiffness: float, damping: float, threshold: float, refractory: float):
        self._stiffness, self._damping = stiffness, damping
        self._threshold, self._refractory = threshold, refractory
        self._event: tuple[float, np.ndarray, np.ndarray, np.ndarray] | None = None
        self._held: np.ndarray | None = None

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        if self._held is None or self._is_surprised(seconds - delay, seen):
            then = seconds - delay
            error, velocity = self._predict(seen, seen.tilt, delay)
            tilt = self._stiffness * error - self._damping * velocity
            self._event = then, seen.position_error, seen.velocity, seen.tilt
            self._held = _moment(tilt)
        return self._held

    def _is_surprised(self, then: float, seen: Picture) -> bool:
        assert self._event is not None
        at, error, velocity, tilt = self._event
        since = then - at
        if since < self._refractory:
            return False
        expected = error - velocity * since - BALL_ACCELERATION * tilt * since**2 / 2
        return bool((np.abs(seen.position_error - expected) > self._threshold).any())

    @staticmethod
    def _predict(seen: Picture, tilt: np.ndarray, delay: float) -> tuple[np.ndarray, np.ndarray]:
        acceleration = BALL_ACCELERATION * tilt
        return (seen.position_error - seen.velocity * delay - acceleration * delay**2 / 2,
                seen.velocity + acceleration * delay)


class BangBang:
    """Young and Meiry (1965): before a plant of high order, novices push all the way one way, then the other.

    The side is that of the error some time ahead, ``e - T v``; novices look little ahead and switch late.

    Args:
        look_ahead: T, s.
        dead_band: m.
        strokes: keystrokes of a push.
    """

    def __init__(self, look_ahead: float, dead_band: float, strokes: int):
        self._look_ahead, self._dead_band = look_ahead, dead_band
        self._push = min(strokes * KEYSTROKE, HUMAN_MOMENT_LIMIT)

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        ahead = seen.position_error - self._look_ahead * seen.velocity
        return np.where(np.abs(ahead) < self._dead_band, 0.0, np.copysign(self._push, ahead))


class Surge:
    """Pulses (Young and Meiry, 1965; Costello, 1968): a surge towards the goal, then wait and see.

    Costello's surge model has a steady mode for small errors and a surge for large ones; here the surge is a push for a
    time that grows with the error, and the wait is as long as it takes to see what came of it.

    Args:
        seconds_a_metre: of a surge, s/m.
        wait: after a surge, s.
        dead_band: m.
        look_ahead: s, see :class:`BangBang`.
    """

    def __init__(self, seconds_a_metre: float, wait: float, dead_band: float, look_ahead: float):
        self._seconds_a_metre, self._wait = seconds_a_metre, wait
        self._dead_band, self._look_ahead = dead_band, look_ahead
        self._surge: np.ndarray | None = None
        self._until = self._waits_until = 0.0

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        ahead = seen.position_error - self._look_ahead * seen.velocity
        if self._surge is not None and seconds < self._until:
            return self._surge
        if self._surge is not None and seconds < self._waits_until:
            return np.zeros_like(held)
        self._surge = np.where(np.abs(ahead) < self._dead_band, 0.0, np.copysign(KEYSTROKE, ahead))
        if not self._surge.any():
            return self._surge
        self._until = seconds + self._seconds_a_metre * float(np.abs(ahead).max())
        self._waits_until = self._until + self._wait
        return self._surge


class Contrary:
    """Does the opposite of what another law wants: an adversary.

    Args:
        law: the other one.
    """

    def __init__(self, law: Law):
        self._law = law

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        return -self._law.wanted(seconds, seen, delay, held)


class Blind:
    """Wants any moment, for some time, whatever the ball does: a sham.

    Args:
        rate: of changes of mind, 1/s.
        random: of them.
    """

    def __init__(self, rate: float, random: np.random.Generator):
        self._rate, self._random = rate, random
        self._until = 0.0
        self._wanted: np.ndarray | None = None

    def wanted(self, seconds: float, seen: Picture, delay: float, held: np.ndarray) -> np.ndarray:
        """See :class:`Law`."""
        if self._wanted is None or seconds >= self._until:
            strokes = round(HUMAN_MOMENT_LIMIT / KEYSTROKE)
            self._wanted = KEYSTROKE * self._random.integers(-strokes, strokes + 1, held.shape)
            self._until = seconds + float(self._random.exponential(1.0 / self._rate))
        return self._wanted
