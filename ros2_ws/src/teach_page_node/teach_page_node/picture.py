# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""What the page shows at one moment, as the browser gets it."""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from shared_control.verdict import Verdict
from shared_control_ros.watching.outcome import Outcome
from shared_control_ros.watching.scene import Moments, Parts

from .history import History

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
    asked: Moments | None = None
    """The push that the person's keys have added up to, along the task's axes, (k,), N m"""
    parts: Parts | None = None
    """What the controller used of both at one tick, and the sum."""
    phase: str | None = None
    episode: int | None = None
    time_left: float | None = None
    """What is left of the episode, s."""
    episode_seconds: float | None = None
    """The longest that it lasts, s."""
    rests_left: int = 0
    """How often the ball still has to be brought to rest before the practice may end."""
    next_in: float | None = None
    """Until the next episode begins, s."""
    outcome: Outcome | None = None
    """How the last episode ended."""
    ended: tuple[str, int] | None = None
    """Phase and number of the last episode that has ended, which a verdict is about."""
    verdict: Verdict = Verdict.NONE
    """What a person has said of it."""
    ends_teaching: bool = False
    """Whether the teaching ends with this episode."""
    ending: dict[str, Any] | None = None
    """What becomes of the session after the teaching."""
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
    """How long the robot has said nothing since the page is there, s; None: it speaks."""
    notice: str = ''
    time: float = 0.0
    """Time of the charts, s: the robot's, or that of the replay."""
    history: History = field(default_factory=History)
    replay: dict[str, Any] | None = None
    """Position, length (s), speed and whether it plays."""
    trace: list[list[float | None]] | None = None
    """Time and moments of the seconds before, when a replay has jumped there; None: nothing has changed."""

    def message(self) -> dict[str, Any]:
        """For the browser, without the history."""
        return {
            'q': _rounded(self.q), 'ball': _rounded(self.ball), 'on_tray': _rounded(self.ball_on_tray),
            'pitch': _rounded(self.pitch), 'tilt': _rounded(self.tilt),
            'asked': _rounded(self.asked), **self._moments(), 'phase': self.phase, 'episode': self.episode,
            'rests_left': self.rests_left, 'next_in': _rounded(self.next_in),
            'outcome': None if self.outcome is None else asdict(self.outcome),
            'ended': self.ended, 'verdict': self.verdict,
            'ends_teaching': self.ends_teaching, 'ending': self.ending,
            'trace': None if self.trace is None else [[_rounded(value) for value in row] for row in self.trace],
            'time_left': _rounded(self.time_left), 'episode_seconds': _rounded(self.episode_seconds),
            'share': _rounded(self.human_share),
            'success': _rounded(self.success), 'keys': self.keys, 'hand': self.hand,
            'paused': self.paused, 'silent_for': _rounded(self.silent_for),
            'notice': self.notice, 'time': _rounded(self.time), 'replay': self.replay}

    def _moments(self) -> dict[str, Any]:
        """Those of one tick, or none at all."""
        names = Parts._fields
        values = [None] * 3 if self.parts is None else [_rounded(moment) for moment in self.parts]
        return dict(zip(names, [None] * 3 if None in values else values, strict=True))


def _rounded(value: float | np.ndarray | Moments | None) -> Any:
    """0.1 mm and 0.1 mrad are finer than a screen. None for what is not finite, which JSON cannot say."""
    if value is None or not np.isfinite(value).all():
        return None
    return [round(float(v), 4) for v in value] if isinstance(value, np.ndarray | tuple) else round(float(value), 4)
