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

"""How an episode ended, in the words that page, terminal and replay have for it. Needs no ROS."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from shared_control.tasks.task import Task

_LAST = 0.25
"""Progress is told every 0.1 s: with as much of its time left an episode has come to its end, s."""
_FIRST = 0.5
"""What is told so soon after an episode's begin is its length: at once, and every 0.1 s from then on, s."""


@dataclass(frozen=True)
class Outcome:
    """One episode that is over."""

    is_good: bool
    """The ball is where it should be."""
    words: str
    """A short sentence."""


class FirstLeft(NamedTuple):
    """The first that was heard of an episode's time left."""

    after: float
    """The episode's begin, s."""
    seconds: float
    """What was left."""


def episode_length(task: Task, phase: str | None, first_left: FirstLeft | None) -> float:
    """The longest that an episode lasts, s: as the agent said, or as the task has it when its begin was not heard.

    Args:
        phase: ``teach`` or ``test``.
        first_left: None: nothing was heard.
    """
    if first_left is not None and first_left.after <= _FIRST and first_left.seconds > 0.0:
        return first_left.seconds
    return task.test_seconds if phase == 'test' else task.episode_seconds


def has_left(task: Task, on_tray: Sequence[float]) -> bool:
    """Whether a ball at ``on_tray``, (3,), m, in the tray's frame, is no longer on the tray."""
    along, across, above = on_tray
    scene = task.scene
    beside = len(task.axes) > 1 and abs(across) > scene.half_width + scene.ball.radius
    return above < 0.0 or beside or abs(along) > scene.half_length + scene.ball.radius


def outcome_of(task: Task, length: float, time_left: float | None, on_tray: Sequence[float] | None) -> Outcome:
    """How the episode ended of which this was seen last.

    Args:
        length: of the episode that comes to its end, s; see :func:`episode_length`.
        time_left: of the episode, s.
        on_tray: where the ball was, (3,), m, in the tray's frame.
    """
    left = 0.0 if time_left is None else time_left
    if left > _LAST or (on_tray is not None and has_left(task, on_tray)):
        return Outcome(False, f'The ball fell after {max(length - left, 0.0):.0f} s.')
    kept = f'The ball was kept for {length:.0f} s'
    if on_tray is None:
        return Outcome(False, f'{kept}.')
    off = math.dist(on_tray[:2] if len(task.axes) > 1 else on_tray[:1], task.scene.goal[:len(task.axes)])
    where = 'in the middle' if len(task.axes) == 1 else 'at the goal'
    if off <= task.scene.goal_radius:
        return Outcome(True, f'{kept}, and is {where}: well done.')
    return Outcome(False, f'{kept}; in the end {100 * off:.0f} cm from the {where.split()[-1]}.')
