"""Observation, reward and end of the ball-balancing task (3.3 and appendix)."""

import math
from dataclasses import dataclass

import numpy as np

from .settings import DEFAULT_TASK, TaskSettings

OBSERVATION_BOUND = 20.0
"""Observations are clipped to this; a ball on the tray stays within 3."""

BALL_START_RANGE = (-0.6, -0.3)
"""Where the ball is dropped, x in the base frame, m (appendix)."""


@dataclass(frozen=True)
class BalanceState:
    """What the task looks at, in SI units."""

    position_error: float
    """e_x = tray centre - ball along base x, m"""
    ball_velocity: float
    """Along base x, m/s"""
    pitch: float
    """Of the tray about base y, rad"""
    ball_height: float
    """Above the base, m"""
    manipulability: float
    """k_w (34)"""


class BalanceTask:
    """The task, as the default or the thesis has it."""

    def __init__(self, settings: TaskSettings = DEFAULT_TASK):
        self.settings = settings

    def observation(self, state: BalanceState) -> np.ndarray:
        """Position error, velocity and pitch, scaled; (3,), float32."""
        raw = np.array([state.position_error, state.ball_velocity, state.pitch])
        if self.settings.observation_scales is None:
            low, high = raw.min(), raw.max()
            scaled = (raw - low) / (high - low) if high > low else np.zeros(3)
        else:
            scaled = raw / self.settings.observation_scales
        return np.clip(scaled, -OBSERVATION_BOUND, OBSERVATION_BOUND).astype(np.float32)

    def has_fallen(self, state: BalanceState) -> bool:
        """Whether the ball has left the tray."""
        return state.ball_height < self.settings.fallen_below

    def reward_terms(self, state: BalanceState) -> dict[str, float]:
        """The terms of (38) by name, unscaled: R_alpha, R_V, R_kw, R_P, R_Pe; or ``fall`` alone."""
        s = self.settings
        if self.has_fallen(state):
            return {'fall': s.fall_reward}
        error = state.position_error ** 2 / s.position_error_max_squared
        k_w2 = state.manipulability ** 2
        return {
            'R_alpha': -s.weight_pitch * state.pitch ** 2,
            'R_V': -s.weight_velocity * (state.ball_velocity ** 2 + s.weight_margin * math.floor(error)),
            'R_kw': s.weight_manipulability * (k_w2 if s.rewards_high_manipulability else 1.0 - k_w2),
            'R_P': -s.weight_position * error,
            'R_Pe': math.exp(s.rate_centre * error),
        }


class BallStarts:
    """Where the ball is dropped, episode after episode: uniform in a range.

    Args:
        seed: the same seed gives the same starts, here, in the simulator node and in the environment.
        start_range: lowest and highest x in the base frame, m.
    """

    def __init__(self, seed: int | None = None, start_range: tuple[float, float] = BALL_START_RANGE):
        self._range = start_range
        self.seed(seed)

    def seed(self, seed: int | None) -> None:
        """Begin the sequence that belongs to ``seed``."""
        self._random = np.random.default_rng(seed)

    def next(self) -> float:
        """x in the base frame, m."""
        return float(self._random.uniform(*self._range))
