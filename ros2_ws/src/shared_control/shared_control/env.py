"""The Gymnasium environment of the task, on whatever plant it is given."""

from typing import Any

import gymnasium
import numpy as np

from .plant import Plant, PlantState
from .rates import POLICY_PERIOD
from .robot.model import PandaModel, manipulability, pitch
from .tasks.balance.settings import DEFAULT_TASK, TaskSettings
from .tasks.balance.task import OBSERVATION_BOUND, BalanceState, BalanceTask


class BalanceEnv(gymnasium.Env[np.ndarray, np.ndarray]):
    """Balance the ball: one step is one policy period (20 ms).

    - Action, (1,) in [-1, 1]: M_yai = action * ``settings.action_scale`` N m.
    - Observation, (3,), float32: position error, ball velocity, tray pitch, scaled as ``settings`` says.
    - Reward: the sum of the terms of (38), times ``settings.reward_scale``.
    - Terminated when the ball falls; truncated after ``settings.episode_seconds``.
    - ``info``: ``m_y_agent``, ``m_y_human``, ``m_y_applied`` (N m), ``reward_terms`` (unscaled), ``state``
      (:class:`BalanceState`), ``fallen``.

    Args:
        plant: in this process (:class:`LocalPlant`) or on the graph.
        settings: the task.
        human_only: the agent's moment is not applied: the person alone moves the tray (4.7).
    """

    metadata: dict[str, Any] = {'render_modes': []}  # noqa: RUF012 - as Gymnasium declares it

    def __init__(self, plant: Plant, settings: TaskSettings = DEFAULT_TASK, human_only: bool = False):
        self.plant = plant
        self._agent_scale = 0.0 if human_only else settings.action_scale
        self.task = BalanceTask(settings)
        self.settings = settings
        self._model = PandaModel()
        self._steps = round(settings.episode_seconds / POLICY_PERIOD)
        self._step = 0
        self.observation_space = gymnasium.spaces.Box(-OBSERVATION_BOUND, OBSERVATION_BOUND, (3,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None,
              ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start an episode; a seed begins the sequence of ball starts anew."""
        super().reset(seed=seed)
        self._step = 0
        state = self.describe(self.plant.reset(seed))
        return self.task.observation(state), {'state': state}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Apply ``action`` for 20 ms."""
        m_y_agent = float(np.clip(action[0], -1.0, 1.0)) * self._agent_scale
        plant_state = self.plant.advance(m_y_agent)
        self._step += 1
        state = self.describe(plant_state)
        terms = self.task.reward_terms(state)
        fallen = self.task.has_fallen(state)
        info = {
            'm_y_agent': m_y_agent, 'm_y_human': plant_state.m_y_human, 'm_y_applied': plant_state.m_y_applied,
            'reward_terms': terms, 'state': state, 'fallen': fallen}
        reward = sum(terms.values()) * self.settings.reward_scale
        return self.task.observation(state), reward, fallen, not fallen and self._step >= self._steps, info

    def describe(self, plant_state: PlantState) -> BalanceState:
        """What the task looks at, from the joints and the ball."""
        position, rotation = self._model.tray_pose(plant_state.q)
        return BalanceState(
            position_error=float(position[0]) - plant_state.ball_position[0],
            ball_velocity=plant_state.ball_velocity[0],
            pitch=pitch(rotation),
            ball_height=plant_state.ball_position[2],
            manipulability=manipulability(self._model.jacobian(plant_state.q)))

    def close(self) -> None:
        """Let go of the plant."""
        self.plant.close()
