"""What becomes of the moments of human and agent before they reach the arm."""

from dataclasses import dataclass

FADE_TIME = 0.1
"""How long the moment of a silent source takes to fade to nothing, s."""


def freshness(age: float, timeout: float) -> float:
    """The part of a command of a given age (s) that still counts.

    1 up to ``timeout`` (s), then falling to 0 within ``FADE_TIME``: a source that vanishes neither latches nor jerks.
    0 for a command whose stamp is further ahead than ``timeout``: time has been set back, and the source has not sent
    anything since.
    """
    if age < -timeout:
        return 0.0
    return min(max(1.0 - (age - timeout) / FADE_TIME, 0.0), 1.0)


def sum_moments(m_y_agent: float, m_y_human: float, limit: float) -> float:
    """M_y = M_yai + M_yh (3.3), N m, kept within ``limit``."""
    return min(max(m_y_agent + m_y_human, -limit), limit)


@dataclass
class MomentSource:
    """The last moment that one source (human or agent) sent, and when."""

    m_y: float = 0.0
    """N m"""
    stamp_ns: int = 0

    def age(self, now_ns: int) -> float:
        """How old it is at ``now_ns``, s; negative when its stamp is ahead."""
        return (now_ns - self.stamp_ns) * 1e-9

    def at(self, now_ns: int, timeout: float) -> float:
        """The moment that counts at ``now_ns``, N m: nothing when its stamp is off by ``timeout`` seconds and more."""
        return self.m_y * freshness(self.age(now_ns), timeout)
