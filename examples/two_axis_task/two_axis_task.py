"""The ball in the middle of the tray, along both of its sides: a task with two moments."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from shared_control import BALANCE, Key, KeyMap, PlantState, RobotModel, Scene, Task, settled
from shared_control.tasks.task import OBSERVATION_BOUND


@dataclass(frozen=True)
class TwoAxisState:
    """What the task looks at: along base x and y, SI units."""

    error: tuple[float, float]
    """Tray centre - ball, m"""
    ball_velocity: tuple[float, float]
    """m/s"""
    lean: tuple[float, float]
    """Where the tray's normal leans, and so where the ball rolls: the sines of the tilts"""
    ball_height: float
    """Above the base, m"""
    manipulability: float

    @property
    def position_error(self) -> float:
        """Distance from the middle, m."""
        return math.hypot(*self.error)

    @property
    def velocity(self) -> float:
        """Speed of the ball, m/s."""
        return math.hypot(*self.ball_velocity)


@dataclass(frozen=True)
class TwoAxis(Task):
    """Bring the ball to the middle by moments about base x and base y, and keep it there."""

    name: ClassVar[str] = 'two_axis'
    axes: ClassVar[tuple[int, ...]] = (3, 4)
    # About x, positive: the ball rolls to -y, away from who looks; about y: to +x, the left of every picture.
    keys: ClassVar[KeyMap] = {Key.UP: (0, 1.0), Key.DOWN: (0, -1.0), Key.LEFT: (1, 1.0), Key.RIGHT: (1, -1.0)}
    scene: ClassVar[Scene] = BALANCE.scene
    reward_names: ClassVar[tuple[str, ...]] = ('near', 'far', 'fast', 'fall')
    observation_size: ClassVar[int] = 6

    reward_scale: float = 0.02
    action_scale: float = 8.0
    """Of a full action, N m."""
    moment_limit: float = 20.0
    """Of the sum of both moments about each axis, N m."""

    @property
    def scale(self) -> np.ndarray:
        """See Task."""
        return np.full(2, self.action_scale)

    @property
    def limit(self) -> np.ndarray:
        """See Task."""
        return np.full(2, self.moment_limit)

    def ball_start(self, random: np.random.Generator) -> np.ndarray:
        """See Task: anywhere but at the edges."""
        return self.scene.home + random.uniform((-0.1, -0.03, 0.0), (0.1, 0.03, 0.0))

    def describe(self, state: PlantState, model: RobotModel) -> TwoAxisState:
        """See Task."""
        position, rotation = model.tray_pose(state.q)
        ball_x, ball_y, ball_z = state.ball_position
        v_x, v_y, _ = state.ball_velocity
        return TwoAxisState(
            error=(float(position[0]) - ball_x, float(position[1]) - ball_y),
            ball_velocity=(v_x, v_y), lean=(float(rotation[0, 2]), float(rotation[1, 2])),
            ball_height=ball_z, manipulability=model.manipulability(state.q))

    def observe(self, state: TwoAxisState) -> np.ndarray:
        """See Task: errors, velocities and lean, scaled."""
        raw = np.array([*state.error, *state.ball_velocity, *state.lean])
        scaled = raw / [0.1, 0.1, 0.15, 0.15, 0.05, 0.05]
        return np.clip(scaled, -OBSERVATION_BOUND, OBSERVATION_BOUND).astype(np.float32)

    def reward_terms(self, state: TwoAxisState) -> dict[str, float]:
        """See Task."""
        if self.failed(state):
            return {'fall': -5000.0}
        distance = state.position_error
        return {'near': math.exp(-(distance / 0.05) ** 2), 'far': -10.0 * distance, 'fast': -state.velocity ** 2}

    def failed(self, state: TwoAxisState) -> bool:
        """See Task: the ball is below the tray."""
        return state.ball_height < 0.836

    def succeeded(self, position_error: np.ndarray, velocity: np.ndarray, failed: bool) -> bool:
        """See Task: at rest in the middle at the end."""
        return not failed and settled(position_error) < self.scene.goal_radius and settled(velocity) < 0.03
