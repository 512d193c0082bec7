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

"""What a simulated tutor sees of tray and ball, along the axes of the task."""

from dataclasses import dataclass

import numpy as np

from ..plant import PlantState
from ..robot.model import RobotModel
from ..tasks.task import Task

_ROLLS: dict[int, tuple[int, float]] = {3: (1, -1.0), 4: (0, 1.0)}
"""Along which axis of the base, and which way, a ball rolls on a tray that has turned about base x (3) or y (4)."""


@dataclass(frozen=True, eq=False)
class Picture:
    """What there is to see, (k,) each: along the way that the ball rolls when the moment about that axis is positive.

    So a tutor presses the key of a positive moment for a positive error, whatever the axis.
    """

    position_error: np.ndarray
    """Where the ball should be, minus where it is, m"""
    velocity: np.ndarray
    """Velocity of the ball, m/s"""
    tilt: np.ndarray
    """Tilt of the tray, rad"""


def can_teach(task: Task) -> bool:
    """Whether simulated tutors know how to: they tilt trays about base x, base y or both."""
    return all(axis in _ROLLS for axis in task.axes)


class Eyes:
    """Makes a :class:`Picture` of a plant.

    Args:
        task: its axes, and where the ball should be (:meth:`Task.aim`).

    Raises:
        ValueError: the task has other axes than tutors know.
    """

    def __init__(self, task: Task):
        if not can_teach(task):
            raise ValueError(f'simulated tutors do not know the axes of the task {task.name}: teach it without one')
        self._task = task
        self._model = RobotModel()

    def look(self, state: PlantState) -> Picture:
        """What there is to see now."""
        position, rotation = self._model.tray_pose(state.q)
        ball, velocity = np.array(state.ball_position), np.array(state.ball_velocity)
        aim = self._task.aim((rotation.T @ (ball - position))[:2])
        target = position + rotation[:, :2] @ aim
        rolls = [_ROLLS[axis] for axis in self._task.axes]
        return Picture(
            np.array([sign * (target[along] - ball[along]) for along, sign in rolls]),
            np.array([sign * velocity[along] for along, sign in rolls]),
            np.array([_tilt(rotation, along, sign) for along, sign in rolls]))


def _tilt(rotation: np.ndarray, along: int, sign: float) -> float:
    """How far the tray's normal leans along an axis of the base, rad."""
    across = 1 - along
    return sign * float(np.arctan2(rotation[along, 2], np.hypot(rotation[across, 2], rotation[2, 2])))
