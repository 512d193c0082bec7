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

"""Observation, reward and end of the ball-balancing task (3.3 and appendix)."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...bounds import bounded
from ...keys import LEFT_AND_RIGHT, KeyMap
from ...plant import PlantState
from ...robot.model import RobotModel, pitch
from ...scene import Box, Scene
from ..settings_check import check_numbers
from ..task import OBSERVATION_BOUND, Task, settled

BALL_START_RANGE = (-0.6, -0.3)
"""Where the ball is dropped, x in the base frame, m (appendix)."""

TRAY = Scene(
    half_length=0.2, half_width=0.05, surface=0.006, wall=0.01, goal_radius=0.02,
    home=(-0.485, 0.008, 0.94),  # y and z: appendix
    boxes=(
        Box((0.0, 0.0, 0.003), (0.41, 0.11, 0.006)),
        Box((0.2025, 0.0, 0.011), (0.005, 0.11, 0.01)), Box((-0.2025, 0.0, 0.011), (0.005, 0.11, 0.01)),
        Box((0.0, 0.0525, 0.011), (0.4, 0.005, 0.01)), Box((0.0, -0.0525, 0.011), (0.4, 0.005, 0.01))))
"""40 x 10 cm with walls lower than the ball is wide; a test compares it with the URDF."""


@dataclass(frozen=True)
class BalanceState:
    """What the task looks at, in SI units."""

    position_error: float
    """e_x = tray centre - ball along base x, m"""
    velocity: float
    """Velocity of the ball along base x, m/s"""
    pitch: float
    """Pitch of the tray about base y, rad"""
    ball_height: float
    """Above the base, m"""
    manipulability: float
    """k_w (34)"""


@dataclass(frozen=True)
class Balance(Task):
    """Bring the ball to the centre of the tray and keep it there, by a moment about base y.

    The defaults of the reward's weights are those of the appendix.
    """

    name: ClassVar[str] = 'balance'
    axes: ClassVar[tuple[int, ...]] = (4,)
    keys: ClassVar[KeyMap] = LEFT_AND_RIGHT
    scene: ClassVar[Scene] = TRAY
    reward_names: ClassVar[tuple[str, ...]] = ('R_alpha', 'R_V', 'R_kw', 'R_P', 'R_Pe', 'fall')
    observation_size: ClassVar[int] = 3
    errors: ClassVar[tuple[int, ...]] = (0,)
    preset: ClassVar[str] = 'guided'

    fallen_below: float = 0.836
    """Height under which the ball has fallen, m (appendix)."""
    fall_reward: float = -5000.0
    action_scale: float = 8.0
    """M_yai of a full action, N m."""
    moment_limit: float = 20.0
    """Bound of |M_yai + M_yh|, N m."""
    observation_scales: tuple[float, float, float] | None = (0.1, 0.15, 0.05)
    """What position error (m), velocity (m/s) and pitch (rad) are divided by. None squeezes the three by their own
    minimum and maximum at every step, as the appendix does, which destroys their sign and scale."""
    rewards_high_manipulability: bool = True
    """True: w_kw k_w^2 as in (35). False: w_kw (1 - k_w^2) as in the appendix."""
    reward_scale: float = 0.02
    """What the reward is multiplied by before the learner sees it."""

    position_error_max_squared: float = 0.0642
    """m^2: ||e_x|| in (33), (36), (37) is the squared position error over this."""
    weight_pitch: float = 1.0
    """(31)"""
    weight_velocity: float = 0.333
    """(32)"""
    weight_margin: float = 5.0
    """(33), on the whole part of ||e_x||"""
    weight_position: float = 10.0
    """(36)"""
    rate_centre: float = -20.0
    """(37)"""
    weight_manipulability: float = 0.5
    """(35)"""

    velocity_max: ClassVar[float] = 0.03
    """Mean |velocity| of a success, m/s; that of the position error is the scene's ``goal_radius``."""

    def __post_init__(self) -> None:
        for expected, names in (
                ('of seconds', ('episode_seconds',)), ('of N m', ('action_scale', 'moment_limit')),
                ('above 0', ('reward_scale', 'position_error_max_squared')),
                ('of at least 0', ('weight_pitch', 'weight_velocity', 'weight_margin', 'weight_position',
                                   'weight_manipulability')),
                ('of at most 0', ('fall_reward', 'rate_centre')), ('of either sign', ('fallen_below',))):
            check_numbers(expected, ((name, getattr(self, name)) for name in names))
        check_numbers('above 0', ((f'observation_scales[{number}]', scale)
                                  for number, scale in enumerate(self.observation_scales or ())))

    @property
    def scale(self) -> np.ndarray:
        """See :class:`Task`."""
        return np.array([self.action_scale])

    @property
    def limit(self) -> np.ndarray:
        """See :class:`Task`."""
        return np.array([self.moment_limit])

    def ball_start(self, random: np.random.Generator) -> np.ndarray:
        """See :class:`Task`: uniform along base x."""
        return np.array([random.uniform(*BALL_START_RANGE), *self.scene.home[1:]])

    def describe(self, state: PlantState, model: RobotModel) -> BalanceState:
        """See :class:`Task`."""
        position, rotation = model.tray_pose(state.q)
        return BalanceState(
            position_error=float(position[0]) - state.ball_position[0],
            velocity=state.ball_velocity[0],
            pitch=pitch(rotation),
            ball_height=state.ball_position[2],
            manipulability=model.manipulability(state.q))

    def observe(self, state: BalanceState) -> np.ndarray:
        """Position error, velocity and pitch, scaled; (3,), float32."""
        raw = np.array([state.position_error, state.velocity, state.pitch])
        if self.observation_scales is None:
            low, high = raw.min(), raw.max()
            scaled = (raw - low) / (high - low) if high > low else np.zeros(3)
        else:
            scaled = raw / self.observation_scales
        return bounded(scaled, OBSERVATION_BOUND).astype(np.float32)

    def failed(self, state: BalanceState) -> bool:
        """Whether the ball has left the tray."""
        return state.ball_height < self.fallen_below

    def reward_terms(self, state: BalanceState) -> dict[str, float]:
        """The terms of (38) by name, unscaled: R_alpha, R_V, R_kw, R_P, R_Pe; or ``fall`` alone."""
        if self.failed(state):
            return {'fall': self.fall_reward}
        error = state.position_error ** 2 / self.position_error_max_squared
        k_w2 = state.manipulability ** 2
        return {
            'R_alpha': -self.weight_pitch * state.pitch ** 2,
            'R_V': -self.weight_velocity * (state.velocity ** 2 + self.weight_margin * math.floor(error)),
            'R_kw': self.weight_manipulability * (k_w2 if self.rewards_high_manipulability else 1.0 - k_w2),
            'R_P': -self.weight_position * error,
            'R_Pe': math.exp(self.rate_centre * error),
        }

    def succeeded(self, position_error: np.ndarray, velocity: np.ndarray, failed: bool) -> bool:
        """The ball was kept, and is at rest in the centre at the end (4.2)."""
        return (not failed and settled(position_error) < self.scene.goal_radius
                and settled(velocity) < self.velocity_max)
