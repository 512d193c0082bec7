"""What the teaching screen shows."""

from dataclasses import dataclass, field

import numpy as np
from shared_control.scene import Scene as TaskScene
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task

Moments = tuple[float, ...]


@dataclass
class Scene:
    """One moment of the lesson; None is what nobody has said (yet)."""

    task: Task = BALANCE
    """What is taught: its geometry, and along which axes moments are."""
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
    tilt: float | None = None
    """How far the tray is from level, rad."""
    human: Moments = (0.0,)
    """Along the task's axes, (k,), N m"""
    agent: Moments | None = None
    """Likewise."""
    applied: Moments | None = None
    """The sum as the controller applies it, likewise."""
    moment_limit: float = 10.0
    """Bound of the human's moment about each axis, N m; the bars reach to twice that."""
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

    @property
    def tray(self) -> TaskScene:
        """The geometry of the task."""
        return self.task.scene

    @property
    def from_above(self) -> bool:
        """Whether the tray is drawn from above: with two axes the side hides one."""
        return len(self.task.axes) > 1
