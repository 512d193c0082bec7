"""What the page shows at one moment, as the browser gets it."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .history import History

Moments = tuple[float, ...]
LIT_FOR = 0.15
"""A key that was pressed is lit for this long at least, s."""


@dataclass
class Picture:
    """One moment; None is what nobody has said (yet). SI units, positions in the base frame."""

    q: np.ndarray | None = None
    """(7,), rad"""
    ball: np.ndarray | None = None
    """(3,), m"""
    ball_on_tray: np.ndarray | None = None
    """(3,), m: along, across and above the tray, in its frame."""
    pitch: float | None = None
    """Pitch of the tray, rad; positive: the left of the picture (base +x) is down."""
    tilt: float | None = None
    """How far the tray is from level, rad."""
    human: Moments | None = None
    """Along the task's axes, (k,), N m"""
    agent: Moments | None = None
    """Likewise."""
    applied: Moments | None = None
    """The sum as the controller applies it, likewise."""
    phase: str | None = None
    episode: int | None = None
    time_left: float | None = None
    """What is left of the episode, s."""
    human_share: float | None = None
    """0..1"""
    success: float | None = None
    """Share of the last test that succeeded, 0..1."""
    keys: list[int] = field(default_factory=lambda: [0, 0, 0])
    """The page's keys in the order of ``Key``: 1 while lit."""
    hand: str = ''
    """The source of the latest key press."""
    paused: bool = False
    silent_for: float | None = None
    """How long the robot has said nothing, s; None: it speaks."""
    notice: str = ''
    time: float = 0.0
    """Time of the charts, s: the robot's, or that of the replay."""
    history: History = field(default_factory=History)
    replay: dict[str, Any] | None = None
    """Position, length (s), speed and whether it plays."""

    def message(self) -> dict[str, Any]:
        """For the browser, without the history."""
        return {
            'q': _rounded(self.q), 'ball': _rounded(self.ball), 'on_tray': _rounded(self.ball_on_tray),
            'pitch': _rounded(self.pitch), 'tilt': _rounded(self.tilt),
            'human': _rounded(self.human), 'agent': _rounded(self.agent),
            'applied': _rounded(self.applied), 'phase': self.phase, 'episode': self.episode,
            'time_left': _rounded(self.time_left), 'share': _rounded(self.human_share),
            'success': _rounded(self.success), 'keys': self.keys, 'hand': self.hand,
            'paused': self.paused, 'silent_for': _rounded(self.silent_for),
            'notice': self.notice, 'time': _rounded(self.time), 'replay': self.replay}


def _rounded(value: float | np.ndarray | Moments | None) -> Any:
    """0.1 mm and 0.1 mrad are finer than a screen. None for what is not finite, which JSON cannot say."""
    if value is None or not np.isfinite(value).all():
        return None
    return [round(float(v), 4) for v in value] if isinstance(value, np.ndarray | tuple) else round(float(value), 4)
