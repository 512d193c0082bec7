"""A simulated tutor: a model of someone who watches the tray and presses keys."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from ..envs.plant import POLICY_PERIOD, PlantState
from ..robot.model import PandaModel, pitch
from .keystrokes import HUMAN_MOMENT_LIMIT, KEYSTROKE, Key, KeyMoment
from .profiles import TutorProfile

BALL_ACCELERATION = 5.0 / 7.0 * 9.81
"""Of a ball that rolls without slipping, m/s^2 for each rad of tilt."""

TILT_OF_MOMENT = 0.006
"""What a tutor expects a moment to do to the tray within a few tenths of a second, rad/(N m)."""

TILT_WANTED_MAX = 0.09
"""rad: no tutor asks for a steeper tray."""


@dataclass(frozen=True)
class Picture:
    """What there is to see."""

    position_error: float
    """Tray centre - ball, along base x, m"""
    velocity: float
    """Of the ball along base x, m/s"""
    pitch: float
    """Of the tray, rad"""


@dataclass(frozen=True)
class _Memory:
    seconds: float
    picture: Picture
    m_y_human: float


class SimulatedTutor:
    """Sees late and inexactly, thinks ahead, and presses at most one key at a time.

    At each decision the tutor has the picture of ``reaction_time`` ago, with noise on it. From it and from the keys
    pressed since, the tutor predicts ball and tilt of now, and compares the tilt that the robot produces on its own
    with the one that would bring the ball to the centre (a spring and a damper). What lacks, in whole keystrokes, is
    what the tutor wants the keys to hold; one key press goes one keystroke there, space goes to nothing. So a tutor
    lets go when the robot does well.

    As :class:`shared_control.envs.local_plant.Person` it holds the keys of an environment in process; a node calls
    :meth:`key` and publishes what it returns.

    Args:
        profile: who it is.
        seed: of noise and of the sham's keys; :meth:`reset` takes another.
    """

    def __init__(self, profile: TutorProfile, seed: int | None = None):
        self.profile = profile
        self._model = PandaModel()
        self._keys = KeyMoment()
        self._random = np.random.default_rng(seed)
        self.reset(None)

    def reset(self, seed: int | None) -> None:
        """A new episode: no keys held, nothing seen yet. A ``seed`` begins the random numbers anew."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self._keys.release()
        self._steps = 0
        self._memory: deque[_Memory] = deque()
        self._may_press_at = 0.0

    def moment(self, state: PlantState) -> float:
        """M_yh for the coming policy period, N m (see ``Person``)."""
        key = self.key(self._steps * POLICY_PERIOD, self.look(state), self._keys.m_y)
        self._steps += 1
        if key is not None:
            self._keys.press(key)
        return self._keys.m_y

    def look(self, state: PlantState) -> Picture:
        """What there is to see of a plant."""
        position, rotation = self._model.tray_pose(state.q)
        return Picture(float(position[0]) - state.ball_position[0], state.ball_velocity[0], pitch(rotation))

    def key(self, seconds: float, picture: Picture, m_y_human: float) -> Key | None:
        """The key to press now, if any.

        Args:
            seconds: time, s; must not run backwards within an episode.
            picture: what there is to see now.
            m_y_human: M_yh as the keys leave it now, N m.
        """
        self._memory.append(_Memory(seconds, picture, m_y_human))
        seen = self._seen(seconds)
        if seen is None or seconds < self._may_press_at:
            return None
        if self.profile.watches:
            key = self._towards(self._wanted(seen, m_y_human), m_y_human)
        else:
            key = self._random.choice([None, *Key])
        if key is not None:
            self._may_press_at = seconds + 1.0 / self.profile.key_rate
        return key

    def _seen(self, seconds: float) -> _Memory | None:
        """What ``GLANCE`` seconds of looking, a reaction time ago, leave in the mind; None when it is too early."""
        latest = seconds - self.profile.reaction_time + 1e-6
        while self._memory[0].seconds < latest - GLANCE:
            self._memory.popleft()
        glance = [memory for memory in self._memory if memory.seconds <= latest]
        if not glance:
            return None
        mean = np.mean([(m.seconds, m.picture.position_error, m.picture.velocity, m.picture.pitch, m.m_y_human)
                        for m in glance], axis=0)
        return _Memory(mean[0], Picture(*mean[1:4]), mean[4])

    def _wanted(self, seen: _Memory, m_y_human: float) -> float:
        """M_yh that would make up for what the robot lacks, in whole keystrokes, N m."""
        p = self.profile
        error, velocity, tilt = (seen.picture.position_error, seen.picture.velocity, seen.picture.pitch) + (
            self._random.normal(0.0, (p.position_noise, p.velocity_noise, p.pitch_noise)))
        tilt_now = tilt + TILT_OF_MOMENT * (m_y_human - seen.m_y_human)
        velocity_now = velocity + BALL_ACCELERATION * (tilt + tilt_now) / 2 * p.reaction_time
        error_now = error - (velocity + velocity_now) / 2 * p.reaction_time
        tilt_wanted = np.clip(p.stiffness * error_now - p.damping * velocity_now, -TILT_WANTED_MAX, TILT_WANTED_MAX)
        lacking = (tilt_wanted - tilt_now) / TILT_OF_MOMENT + m_y_human
        if abs(lacking) < p.tolerance:
            return 0.0
        strokes = max(round(abs(lacking) / KEYSTROKE), 1)
        return float(np.copysign(min(strokes * KEYSTROKE, HUMAN_MOMENT_LIMIT), lacking))

    @staticmethod
    def _towards(wanted: float, m_y_human: float) -> Key | None:
        if wanted == m_y_human:
            return None
        if wanted == 0.0:
            return Key.SPACE
        return Key.LEFT if wanted > m_y_human else Key.RIGHT
