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

"""The ball in the centre of a square plate, by moments about base x and base y."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...bounds import bounded
from ...keys import Key, KeyMap
from ...plant import PlantState
from ...robot.model import RobotModel
from ...scene import Scene
from ..settings_check import check_numbers
from ..task import OBSERVATION_BOUND, Task, settled
from .scene import PLATE_SCENE

_OBSERVATION_SCALES = np.array([0.1, 0.1, 0.15, 0.15, 0.05, 0.05])
"""m, m/s and the sine of an angle: what ``balance`` divides its observation by, along both axes."""


@dataclass(frozen=True)
class PlateState:
    """What the task looks at, SI units; pairs are along x and y."""

    ball: tuple[float, float]
    """Where the ball is on the plate, in the tray's frame, m"""
    ball_velocity: tuple[float, float]
    """In the base frame, m/s"""
    lean: tuple[float, float]
    """Sines of the tilt along base x and base y: where to the plate's normal leans, and so the ball rolls"""
    height: float
    """Height of the ball's centre above the tray's frame, m"""
    position_error: float
    """Distance from the goal, m"""
    manipulability: float
    """k_w (34)"""

    @property
    def velocity(self) -> float:
        """Speed of the ball, m/s."""
        return math.hypot(*self.ball_velocity)


@dataclass(frozen=True)
class Plate(Task):
    """Bring the ball to the centre of the plate and keep it there, by moments about base x and base y.

    The reward is that of ``balance`` (31)-(38) with the distance in place of the position error, without (33) and (35):
    the step of the margin, and a manipulability that the task hardly changes.
    """

    name: ClassVar[str] = 'plate'
    preset: ClassVar[str] = 'guided'
    instruction: ClassVar[str] = 'Bring the ball to the centre of the plate and keep it there.'
    axes: ClassVar[tuple[int, ...]] = (3, 4)
    # About x, positive: the ball rolls to -y, away from who looks; about y: to +x, the left of every picture.
    keys: ClassVar[KeyMap] = {Key.LEFT: (1, 1.0), Key.RIGHT: (1, -1.0), Key.UP: (0, 1.0), Key.DOWN: (0, -1.0)}
    scene: ClassVar[Scene] = PLATE_SCENE
    reward_names: ClassVar[tuple[str, ...]] = ('R_alpha', 'R_V', 'R_P', 'R_Pe', 'fall')
    observation_size: ClassVar[int] = 6
    errors: ClassVar[tuple[int, ...]] = (0, 1)
    velocity_max: ClassVar[float] = 0.03
    """Mean speed at the end of a success, m/s; that of the distance is the scene's ``goal_radius``."""
    start: ClassVar[tuple[tuple[float, float], tuple[float, float]]] = ((-0.13, 0.13), (-0.13, 0.13))
    """Where the ball is dropped: ranges of x and y in the tray's frame at rest, m."""

    fall_reward: float = -5000.0
    action_scale: float = 8.0
    """Moment of a full action about each axis, N m."""
    moment_limit: float = 20.0
    """Bound of the sum of both moments about each axis, N m."""
    reward_scale: float = 0.02
    """What the reward is multiplied by before the learner sees it."""
    position_error_max_squared: float = 0.0642
    """m^2: ||e|| in (36), (37) is the squared distance over this."""
    weight_tilt: float = 1.0
    """(31)"""
    weight_velocity: float = 0.333
    """(32)"""
    weight_position: float = 10.0
    """(36)"""
    rate_centre: float = -20.0
    """(37)"""

    def __post_init__(self) -> None:
        for expected, names in (
                ('of seconds', ('episode_seconds',)), ('of N m', ('action_scale', 'moment_limit')),
                ('above 0', ('reward_scale', 'position_error_max_squared')),
                ('of at least 0', ('weight_tilt', 'weight_velocity', 'weight_position')),
                ('of at most 0', ('fall_reward', 'rate_centre'))):
            check_numbers(expected, ((name, getattr(self, name)) for name in names))

    @property
    def scale(self) -> np.ndarray:
        """See :class:`Task`."""
        return np.full(2, self.action_scale)

    @property
    def limit(self) -> np.ndarray:
        """See :class:`Task`."""
        return np.full(2, self.moment_limit)

    def ball_start(self, random: np.random.Generator) -> np.ndarray:
        """See :class:`Task`: uniform over ``start``."""
        x, y, z = self.scene.home
        return np.array([x + random.uniform(*self.start[0]), y + random.uniform(*self.start[1]), z])

    def describe(self, state: PlantState, model: RobotModel) -> PlateState:
        """See :class:`Task`."""
        position, rotation = model.tray_pose(state.q)
        x, y, height = (rotation.T @ (np.array(state.ball_position) - position)).tolist()
        return PlateState(
            ball=(x, y), ball_velocity=(state.ball_velocity[0], state.ball_velocity[1]),
            lean=(float(rotation[0, 2]), float(rotation[1, 2])), height=height,
            position_error=math.hypot(self.scene.goal[0] - x, self.scene.goal[1] - y),
            manipulability=model.manipulability(state.q))

    def on_tray(self, state: PlateState) -> tuple[float, float]:
        """See :class:`Task`."""
        return state.ball

    def observe(self, state: PlateState) -> np.ndarray:
        """From the ball to the plate's centre, velocity and lean, scaled; (6,), float32."""
        x, y = state.ball
        raw = np.array([-x, -y, *state.ball_velocity, *state.lean])
        return bounded(raw / _OBSERVATION_SCALES, OBSERVATION_BOUND).astype(np.float32)

    def failed(self, state: PlateState) -> bool:
        """Whether the ball has left the plate."""
        return state.height < 0.0

    def reward_terms(self, state: PlateState) -> dict[str, float]:
        """The terms of (38) by name, unscaled: R_alpha, R_V, R_P, R_Pe; or ``fall`` alone."""
        if self.failed(state):
            return {'fall': self.fall_reward}
        error = state.position_error ** 2 / self.position_error_max_squared
        tilt = math.asin(min(math.hypot(*state.lean), 1.0))
        return {
            'R_alpha': -self.weight_tilt * tilt ** 2, 'R_V': -self.weight_velocity * state.velocity ** 2,
            'R_P': -self.weight_position * error, 'R_Pe': math.exp(self.rate_centre * error)}

    def succeeded(self, position_error: np.ndarray, velocity: np.ndarray, failed: bool) -> bool:
        """The ball was kept, and is at rest at the goal at the end (4.2)."""
        return (not failed and settled(position_error) < self.scene.goal_radius
                and settled(velocity) < self.velocity_max)
