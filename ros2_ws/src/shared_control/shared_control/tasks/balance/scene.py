"""What there is to see and touch in the task: ball and tray."""

from dataclasses import dataclass

TRAY_HOME_X = -0.485
"""Where the tray's centre is when the arm is at the reference joints, m."""
BALL_START_Y = 0.008
"""m (appendix)"""
BALL_START_Z = 0.94
"""m (appendix)"""


@dataclass(frozen=True)
class Ball:
    """The ball of the thesis (3.1)."""

    mass: float = 0.17
    """kg"""
    radius: float = 0.015
    """m, as the appendix runs it (the text says 1.5 cm in diameter)"""
    friction: float = 0.8
    """Coulomb coefficient against the tray; there is no rolling friction."""
