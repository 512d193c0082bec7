"""A simulated tutor: a model of someone who watches the tray and presses keys."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, Key, KeyMoment
from ..plant import PlantState
from ..rates import POLICY_PERIOD
from ..robot.model import RobotModel, pitch
from ..tasks.task import Task
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

_STREAM = 1
"""Keeps the tutor's random numbers apart from the ball starts of the same seed."""

_ANY_KEY: Any = [None, Key.LEFT, Key.RIGHT, Key.SPACE]

ROUNDING = 1e-6
"""Times closer than this are equal, s."""


def can_teach(task: Task) -> bool:
    """Whether simulated tutors know how to: they hold the keys of one moment, about base y."""
    return task.axes == (4,)


@dataclass(frozen=True)
class Picture:
    """What there is to see."""

    position_error: float
    """Tray centre - ball, along base x, m"""
    velocity: float
    """Velocity of the ball along base x, m/s"""
    pitch: float
    """Pitch of the tray, rad"""


@dataclass(frozen=True)
class _Memory:
    seconds: float
    picture: Picture
    m_y_human: float


class SimulatedTutor:
    """Sees late and inexactly, thinks ahead, and presses one key at a time, no faster than a hand can.

    What the tutor sees is ``reaction_time`` old and has an error. The tutor knows which keys were pressed since, and
    so what they are about to do. A spring and a damper make the tilt that would bring the ball to the centre; what
    lacks of it in the tilt that the robot makes on its own, in whole keystrokes, is what the keys should hold. One
    press goes one keystroke there; space goes to nothing.

    How far the tutor thinks ahead is a matter of trust. A robot that tilts the tray as the tutor would have, at the
    moment that the tutor now sees, will go on to do so, and needs no help for what is yet to come. A robot that
    does not is taken to keep its tilt as it is. And who trusts the robot leaves more to it. So the tutor lets go of a
    robot that does well. A ball that keeps to one side of the centre wears out the tutor's patience: the tilt wanted
    grows until a press is due.

    As a ``Person`` (:mod:`shared_control_sim.local_plant`) it holds the keys of an environment in process; a node
    calls :meth:`key` and publishes what it returns.

    Args:
        profile: who it is.
        seed: of the errors of perception, and of the keys of who does not watch.
        episodes: taught before.
    """

    def __init__(self, profile: TutorProfile, seed: int = 0, episodes: int = 0):
        self._profile = profile
        self._episodes = episodes
        self._model = RobotModel()
        self._keys = KeyMoment()
        self._begin(seed)

    def reset(self, seed: int | None, episode: int | None = None) -> None:
        """A new episode: no keys held, nothing seen yet, no trust.

        Args:
            seed: begins the random numbers anew.
            episode: which it is, from 1; the next one when not given.
        """
        self._episodes = self._episodes + 1 if episode is None else episode
        self._begin(seed)

    def _begin(self, seed: int | None) -> None:
        self.profile = in_episode(self._profile, max(self._episodes, 1))
        if seed is not None:
            self._random = np.random.default_rng((seed, _STREAM))
        self._keys.release()
        self._steps = 0
        self._memory: deque[_Memory] = deque()
        self._error = np.zeros(3)
        self._trust = 0.0
        self._wearing = 0.0
        self._may_press_at = 0.0

    def moment(self, state: PlantState) -> np.ndarray:
        """M_yh for the coming policy period, (1,), N m (see ``Person``)."""
        key = self.key(self._steps * POLICY_PERIOD, self.look(state), float(self._keys.moment[0]))
        self._steps += 1
        if key is not None:
            self._keys.press(key)
        return self._keys.moment

    def look(self, state: PlantState) -> Picture:
        """What there is to see of a plant."""
        position, rotation = self._model.tray_pose(state.q)
        return Picture(float(position[0]) - state.ball_position[0], state.ball_velocity[0], pitch(rotation))

    def key(self, seconds: float, picture: Picture, m_y_human: float) -> Key | None:
        """The key to press now, if any. Call at 50 Hz or so.

        Args:
            seconds: time, s; must not run backwards within an episode.
            picture: what there is to see now.
            m_y_human: M_yh as the keys leave it now, N m.
        """
        elapsed = seconds - self._memory[-1].seconds if self._memory else 0.0
        self._memory.append(_Memory(seconds, self._blurred(picture, elapsed), m_y_human))
        latest = seconds - self.profile.reaction_time + ROUNDING
        while len(self._memory) > 1 and self._memory[1].seconds <= latest:
            self._memory.popleft()
        seen = self._memory[0]
        if seen.seconds > latest:
            return None
        wanted = self._wanted(seen, seconds - seen.seconds, elapsed, m_y_human)
        if seconds < self._may_press_at:
            return None
        key = _towards(wanted, m_y_human) if self.profile.watches else self._random.choice(_ANY_KEY)
        if key is not None:
            self._may_press_at = seconds + 1.0 / self.profile.key_rate - ROUNDING
        return key

    def _blurred(self, picture: Picture, elapsed: float) -> Picture:
        """The picture as perceived, ``elapsed`` s after the last one."""
        p = self.profile
        kept = np.exp(-elapsed / NOISE_SECONDS)
        self._error = kept * self._error + np.sqrt(1.0 - kept**2) * self._random.normal(
            0.0, (p.position_noise, p.velocity_noise, p.pitch_noise))
        position, velocity, tilt = self._error
        return Picture(picture.position_error + position, picture.velocity + velocity, picture.pitch + tilt)

    def _wanted(self, seen: _Memory, lead: float, elapsed: float, m_y_human: float) -> float:
        """M_yh that makes up for what the robot lacks, in whole keystrokes, N m; ``lead`` s after what was seen."""
        error, velocity, tilt = seen.picture.position_error, seen.picture.velocity, seen.picture.pitch
        robot_tilt = tilt - TILT_OF_MOMENT * seen.m_y_human
        ideal_then = self._ideal_tilt(error, velocity)
        did_well = abs(ideal_then - robot_tilt) < TILT_OF_MOMENT * self.profile.tolerance
        self._trust += (did_well - self._trust) * elapsed / TRUST_SECONDS

        tilt_now = robot_tilt + TILT_OF_MOMENT * m_y_human
        velocity_now = velocity + BALL_ACCELERATION * (tilt + tilt_now) / 2 * lead
        error_now = error - (velocity + velocity_now) / 2 * lead
        ideal_now = self._ideal_tilt(error_now, velocity_now)
        kept = 1.0 - elapsed / PATIENCE_SECONDS
        self._wearing = _bounded(kept * self._wearing + self.profile.patience * error * elapsed, PATIENCE_TILT_MAX)
        ideal = self._trust * ideal_then + (1.0 - self._trust) * ideal_now + self._wearing
        lacking = (ideal - robot_tilt) / TILT_OF_MOMENT
        if abs(lacking) < self.profile.tolerance * (1.0 + self.profile.generosity * self._trust):
            return 0.0
        strokes = max(round(abs(lacking) / KEYSTROKE), 1)
        return math.copysign(min(strokes * KEYSTROKE, HUMAN_MOMENT_LIMIT), lacking)

    def _ideal_tilt(self, error: float, velocity: float) -> float:
        tilt = self.profile.stiffness * error - self.profile.damping * velocity
        return _bounded(tilt, TILT_WANTED_MAX)


def _bounded(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)


def _towards(wanted: float, m_y_human: float) -> Key | None:
    """The key that brings M_yh nearer to what is wanted."""
    if wanted == m_y_human:
        return None
    if wanted == 0.0:
        return Key.SPACE
    return Key.LEFT if wanted > m_y_human else Key.RIGHT
