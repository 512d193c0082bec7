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

"""The predictive tutor: a model of someone who watches the tray, thinks ahead, and presses keys."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from ..bounds import bounded
from ..keys import Key
from ..tasks.balance import BALANCE
from ..tasks.task import Task
from .person import ROUNDING, SimulatedPerson, in_keystrokes, key_towards
from .picture import Picture
from .profiles import TutorProfile, in_episode

BALL_ACCELERATION = 5.0 / 7.0 * 9.81
"""Acceleration of a ball that rolls without slipping, m/s^2 for each rad of tilt."""

TILT_OF_MOMENT = 0.006
"""What a tutor expects a moment to do to the tray within a few tenths of a second, rad/(N m)."""

TILT_WANTED_MAX = 0.09
"""rad: no tutor asks for a steeper tray."""

NOISE_SECONDS = 0.3
"""How long an error of perception lasts, s."""

TRUST_SECONDS = 3.0
"""How fast a tutor comes to trust the robot, or ceases to, s."""

PATIENCE_TILT_MAX = 0.04
"""rad: no tutor asks for more because the ball keeps off the centre."""

PATIENCE_SECONDS = 5.0
"""How long tutors remember that it did, s."""


@dataclass(frozen=True, eq=False)
class _Memory:
    seconds: float
    picture: Picture
    held: np.ndarray


class SimulatedTutor(SimulatedPerson):
    """Sees late and inexactly, thinks ahead, and presses one key at a time, each axis no faster than a finger can.

    What the tutor sees is ``reaction_time`` old and has an error. The tutor knows which keys were pressed since, and
    so what they are about to do. About each axis, a spring and a damper make the tilt that would bring the ball where
    it should be; what lacks of it in the tilt that the robot makes on its own, in whole keystrokes, is what the keys
    should hold. One press goes one keystroke there; space goes to nothing.

    How far the tutor thinks ahead is a matter of trust. A robot that tilts the tray as the tutor would have, at the
    moment that the tutor now sees, will go on to do so, and needs no help for what is yet to come. A robot that
    does not is taken to keep its tilt as it is. And who trusts the robot leaves more to it. So the tutor lets go of a
    robot that does well. A ball that keeps to one side of the centre wears out the tutor's patience: the tilt wanted
    grows until a press is due.

    Args:
        profile: who it is.
        seed: of the errors of perception, and of the keys of who does not watch.
        episodes: taught before.
        task: its axes and keys.
    """

    def __init__(self, profile: TutorProfile, seed: int = 0, episodes: int = 0, task: Task = BALANCE):
        self._profile = profile
        super().__init__(task, seed, episodes)

    def _begin(self) -> None:
        self.profile = in_episode(self._profile, max(self._episodes, 1))
        axes = len(self._task.axes)
        self._memory: deque[_Memory] = deque()
        self._error = np.zeros((3, axes))
        self._trust = np.zeros(axes)
        self._wearing = np.zeros(axes)
        self._may_press_at = np.zeros(axes)

    def key(self, seconds: float, picture: Picture, held: np.ndarray) -> Key | None:
        """See :class:`SimulatedPerson`."""
        elapsed = seconds - self._memory[-1].seconds if self._memory else 0.0
        self._memory.append(_Memory(seconds, self._blurred(picture, elapsed), held))
        latest = seconds - self.profile.reaction_time + ROUNDING
        while len(self._memory) > 1 and self._memory[1].seconds <= latest:
            self._memory.popleft()
        seen = self._memory[0]
        if seen.seconds > latest:
            return None
        wanted = self._wanted(seen, seconds - seen.seconds, elapsed, held)
        resting = seconds < self._may_press_at
        if resting.all():
            return None
        if self.profile.watches:
            key = key_towards(np.where(resting, held, wanted), held, self._task.keys)
        else:
            key = self._any_key()
        if key is not None:
            moved = slice(None) if key is Key.SPACE else self._task.keys[key][0]
            self._may_press_at[moved] = seconds + 1.0 / self.profile.key_rate - ROUNDING
        return key

    def _any_key(self) -> Key | None:
        keys = [None, *self._task.keys, Key.SPACE]
        return keys[self._random.choice(len(keys))]

    def _blurred(self, picture: Picture, elapsed: float) -> Picture:
        """The picture as perceived, ``elapsed`` s after the last one."""
        p = self.profile
        kept = np.exp(-elapsed / NOISE_SECONDS)
        sizes = np.array([[p.position_noise], [p.velocity_noise], [p.pitch_noise]])
        self._error = kept * self._error + np.sqrt(1.0 - kept**2) * self._random.normal(
            0.0, np.broadcast_to(sizes, self._error.shape))
        position, velocity, tilt = self._error
        return Picture(picture.position_error + position, picture.velocity + velocity, picture.tilt + tilt)

    def _wanted(self, seen: _Memory, lead: float, elapsed: float, held: np.ndarray) -> np.ndarray:
        """M_h for what the robot lacks, in whole keystrokes, (k,), N m; ``lead`` s after what was seen."""
        error, velocity, tilt = seen.picture.position_error, seen.picture.velocity, seen.picture.tilt
        robot_tilt = tilt - TILT_OF_MOMENT * seen.held
        ideal_then = self._ideal_tilt(error, velocity)
        did_well = np.abs(ideal_then - robot_tilt) < TILT_OF_MOMENT * self.profile.tolerance
        self._trust = self._trust + (did_well - self._trust) * elapsed / TRUST_SECONDS

        tilt_now = robot_tilt + TILT_OF_MOMENT * held
        velocity_now = velocity + BALL_ACCELERATION * (tilt + tilt_now) / 2 * lead
        error_now = error - (velocity + velocity_now) / 2 * lead
        ideal_now = self._ideal_tilt(error_now, velocity_now)
        kept = 1.0 - elapsed / PATIENCE_SECONDS
        self._wearing = bounded(kept * self._wearing + self.profile.patience * error * elapsed, PATIENCE_TILT_MAX)
        ideal = self._trust * ideal_then + (1.0 - self._trust) * ideal_now + self._wearing
        lacking = (ideal - robot_tilt) / TILT_OF_MOMENT
        unnoticed = self.profile.tolerance * (1.0 + self.profile.generosity * self._trust)
        return np.where(np.abs(lacking) < unnoticed, 0.0, in_keystrokes(lacking, at_least=1))

    def _ideal_tilt(self, error: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        return bounded(self.profile.stiffness * error - self.profile.damping * velocity, TILT_WANTED_MAX)
