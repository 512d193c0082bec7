"""What becomes of the moments of human and agent before they reach the arm."""

import numpy as np

FADE_TIME = 0.1
"""How long the moment of a silent source takes to fade to nothing, s."""


def freshness(age: float, timeout: float) -> float:
    """The part of a command of a given age (s) that still counts.

    1 up to ``timeout`` (s), then falling to 0 within ``FADE_TIME``: a source that vanishes neither latches nor jerks.
    """
    return min(max(1.0 - (age - timeout) / FADE_TIME, 0.0), 1.0)


def sum_moments(agent: np.ndarray, human: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """The sum of both moments (3.3), each axis kept within ``limit``; all (k,), N m."""
    return np.minimum(np.maximum(agent + human, -limit), limit)


class MomentSource:
    """The last moment that one source (human or agent) sent, and when.

    Args:
        size: number of the task's axes, k.
    """

    def __init__(self, size: int):
        self.moment = np.zeros(size)
        """(k,), N m"""
        self.stamp_ns = 0

    def at(self, now_ns: int, timeout: float) -> np.ndarray:
        """The moment that counts at ``now_ns``, (k,), N m: zero when none came for ``timeout`` seconds and more."""
        return self.moment * freshness((now_ns - self.stamp_ns) * 1e-9, timeout)

    def is_stale(self, now_ns: int, timeout: float) -> bool:
        """Whether the last message is older than ``timeout`` seconds."""
        return (now_ns - self.stamp_ns) * 1e-9 > timeout
