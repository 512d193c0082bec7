"""What a test of a policy measured."""

from dataclasses import dataclass

import numpy as np

from .evaluate import TestEpisode

TRACKS = ('position_error', 'velocity', 'velocity_error', 'm_y_agent', 'manipulability')
"""The arrays over time that a :class:`ProtocolResult` holds, by name."""


@dataclass(frozen=True, eq=False)
class ProtocolResult:
    """Tracks of all episodes of one test of one policy, at 50 Hz: one row an episode.

    After the ball has fallen a row is nan.
    """

    test: str
    """``randomized``, ``perturbation``, or ``trajectory 0.25 Hz`` and so on."""
    seconds: np.ndarray
    """Time in the episode, (steps,), s: the end of each policy period."""
    position_error: np.ndarray
    """Tray centre minus ball along base x, (episodes, steps), m"""
    velocity: np.ndarray
    """Of the ball along base x, (episodes, steps), m/s: what the policy sees."""
    velocity_error: np.ndarray
    """Tray minus ball along base x, (episodes, steps), m/s: the rate of the position error."""
    m_y_agent: np.ndarray
    """M_yai over the period that ended then, (episodes, steps), N m"""
    manipulability: np.ndarray
    """k_w (34), (episodes, steps); the thesis quotes 1 - k_w^2."""
    fallen: np.ndarray
    """(episodes,), bool"""

    @property
    def episodes(self) -> tuple[TestEpisode, ...]:
        """The episodes as :mod:`.evaluate` judges them, up to the fall of the ball."""
        known = np.isfinite(self.position_error).sum(axis=1)
        return tuple(
            TestEpisode(error[:steps], velocity[:steps], bool(fallen)) for error, velocity, steps, fallen
            in zip(self.position_error, self.velocity, known, self.fallen, strict=True))
