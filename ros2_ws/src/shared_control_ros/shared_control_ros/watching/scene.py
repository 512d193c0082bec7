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

"""What the teaching screen shows."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from shared_control.keys import KEYSTROKE
from shared_control.scene import Scene as TaskScene
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict

from .outcome import FirstLeft, Outcome, episode_length, has_left

Moments = tuple[float, ...]


class Parts(NamedTuple):
    """The moments of one tick of the controller along the task's axes, (k,) each, N m: they add up."""

    human: Moments
    agent: Moments
    applied: Moments
    """Their sum, within the task's limit."""


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
    tilt: float | None = None
    """How far the tray is from level, rad."""
    human: Moments = (0.0,)
    """Along the task's axes, (k,), N m"""
    parts: Parts | None = None
    """What the controller used of both at its newest tick, and the sum."""
    moment_limit: float = 10.0
    """Bound of the human's moment about each axis, N m; the bars reach to twice that."""
    keystroke: float = KEYSTROKE
    """What one press adds to it, N m."""
    hand: str = 'you'
    """Whose keys count: ``you``, or another source's name."""
    human_share: float | None = None
    """0..1"""
    phase: str | None = None
    """``practice``, ``teach``, ``learn``, ``test``, ``wait``, ``done``; None: nobody has said it (yet)."""
    episode: int | None = None
    began_ns: int = 0
    """When the agent said that phase and episode begin, ns of its clock of the day."""
    time_left: float | None = None
    """What is left of the episode, s."""
    first_left: FirstLeft | None = None
    """What was said of that first."""
    rests_left: int = 0
    """How often the ball still has to be brought to rest before the practice may end."""
    next_in: float | None = None
    """Until the next episode begins, s."""
    outcome: Outcome | None = None
    """How the last episode ended; None once the next one has begun."""
    returns: list[float] = field(default_factory=list)
    """Returns of the episodes so far."""
    discarded: set[int] = field(default_factory=set)
    """Which of ``returns`` are those of episodes that were discarded."""
    ended: tuple[str, int] | None = None
    """Phase and number of the last episode that has ended: the one that a verdict is about."""
    verdict: Verdict = Verdict.NONE
    """What a person has said of it."""
    success: float | None = None
    """Share of the last test that succeeded, 0..1."""
    feedback: str = 'full'
    """What the person is told: one of :data:`shared_control.teaching.feedback.FEEDBACK`."""
    offers_verdicts: bool = True
    """Whether the person is offered to judge episodes."""
    in_session: bool = False
    """Whether a lesson is about to be given: nothing known of it means that it starts."""
    ending: bool = False
    """Whether the teaching ends with this episode."""
    paused: bool = False
    simulator_silent_for: float | None = None
    """How long the simulator has said nothing since the screen is there, s; None: it runs."""
    waiting: str = ''
    """What the session waits for, since when, and in a second line why; empty: nothing, or there is no session."""
    message: str = ''
    """The latest notice to the person."""

    @property
    def counted_returns(self) -> list[float]:
        """Returns of the episodes that were not discarded."""
        return [value for index, value in enumerate(self.returns) if index not in self.discarded]

    @property
    def episode_seconds(self) -> float:
        """The longest that the episode lasts, s."""
        return episode_length(self.task, self.phase, self.first_left)

    @property
    def tray(self) -> TaskScene:
        """The geometry of the task."""
        return self.task.scene

    @property
    def has_fallen(self) -> bool:
        """Whether the ball is no longer on the tray."""
        return self.ball_on_tray is not None and has_left(self.task, self.ball_on_tray.tolist())

    @property
    def ball_along(self) -> float | None:
        """The ball's offset from the middle of the tray along its x axis, m; positive: left in the picture."""
        return None if self.ball_on_tray is None else float(self.ball_on_tray[0])

    @property
    def ball_height(self) -> float | None:
        """Height of the ball's centre above the tray's frame, m."""
        return None if self.ball_on_tray is None else float(self.ball_on_tray[2])

    @property
    def from_above(self) -> bool:
        """Whether the tray is drawn from above: with two axes the side hides one."""
        return len(self.task.axes) > 1
