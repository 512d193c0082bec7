"""What the teaching screen shows."""

from dataclasses import dataclass, field

import numpy as np
from shared_control.scene import Scene as TaskScene
from shared_control.tasks.balance import BALANCE


@dataclass
class Scene:
    """One moment of the lesson; None is what nobody has said (yet)."""

    tray: TaskScene = BALANCE.scene
    """The geometry of the task."""
    pitch: float | None = None
    """Pitch of the tray, rad; positive: the left of the picture (base +x) is down."""
    q: np.ndarray | None = None
    """Joint positions, (7,), rad."""
    ball: np.ndarray | None = None
    """In the base frame, (3,), m."""
    ball_on_tray: np.ndarray | None = None
    """In the tray's frame, (3,), m."""
    ball_along: float | None = None
    """The ball's offset from the middle of the tray along its x axis, m; positive: left in the picture."""
    ball_height: float | None = None
    """Height of the ball's centre above the tray's frame, m."""
    human: float = 0.0
    """N m"""
    agent: float | None = None
    """N m"""
    applied: float | None = None
    """The sum as the controller applies it, N m."""
    moment_limit: float = 10.0
    """Bound of |M_yh|, N m; the bars reach to twice that."""
    hand: str = 'you'
    """Whose keys count: ``you``, or another source's name."""
    human_share: float | None = None
    """0..1"""
    phase: str | None = None
    """``teach``, ``learn``, ``test``, ``wait``, ``done``; None: nobody teaches a robot."""
    episode: int | None = None
    time_left: float | None = None
    """What is left of the episode, s."""
    returns: list[float] = field(default_factory=list)
    """Returns of the episodes so far."""
    success: float | None = None
    """Share of the last test that succeeded, 0..1."""
    paused: bool = False
    simulator_silent_for: float | None = None
    """How long the simulator has said nothing, s; None: it runs."""
    waiting: str = ''
    """What the session waits for, since when, and in a second line why; empty: nothing, or there is no session."""
    message: str = ''
    """The latest notice to the person."""
