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

"""The Gymnasium environment of a task, on whatever plant it is given."""

from typing import Any, Protocol

import gymnasium
import numpy as np

from .bounds import bounded
from .not_copied import NotCopied
from .plant import Plant, PlantState
from .rates import POLICY_PERIOD
from .robot.model import RobotModel
from .tasks.balance import BALANCE
from .tasks.task import OBSERVATION_BOUND, Observer, Task


class Senses(Protocol):
    """What stands between the plant and a learner's eyes: late, noisy."""

    def reset(self, seed: int | None) -> None:
        """A new episode begins."""

    def perceive(self, state: PlantState) -> PlantState:
        """What is seen when the plant is in ``state``; called once a policy period."""


class SharedControlEnv(NotCopied, gymnasium.Env[np.ndarray, np.ndarray]):
    """One step is one policy period (20 ms).

    - Action, (k,) in [-1, 1]: the agent's moment is action * ``task.scale``, N m along the task's axes.
    - Observation: the task's, and the integrals of its position errors when the task ``integrates``; float32.
    - Reward: the sum of the task's terms, times ``task.reward_scale``.
    - Terminated when the task has failed; truncated after ``task.episode_seconds``.
    - ``info``: ``agent``, ``human``, ``applied`` (moments as they counted, (k,), N m), ``reward_terms`` (unscaled),
      ``state`` (the task's), ``on_tray`` (see :meth:`Task.on_tray`), ``failed``.

    Args:
        plant: in this process (``shared_control_sim.local_plant.LocalPlant``) or on the graph.
        task: the task.
        human_only: the agent's moment is not applied: the person alone moves the tray (4.7).
        senses: what the observation is taken from; reward and success are judged by what is true. Perfect when None.
    """

    metadata: dict[str, Any] = {'render_modes': []}  # noqa: RUF012 - as Gymnasium declares it

    def __init__(self, plant: Plant, task: Task = BALANCE, human_only: bool = False,
                 senses: Senses | None = None):
        self.plant = plant
        self.task = task
        self._scale = 0.0 * task.scale if human_only else task.scale
        self._senses = senses
        self._model = RobotModel(plant.spec)
        self._steps = round(task.episode_seconds / POLICY_PERIOD)
        self._step = 0
        self._observer = Observer(task)
        self.observation_space = observation_space(task)
        self.action_space = action_space(task)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None,
              ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start an episode; a seed begins the sequence of ball starts anew."""
        super().reset(seed=seed)
        self._step = 0
        plant_state = self.plant.reset(seed)
        state = self.task.describe(plant_state, self._model)
        self._observer.reset()
        if self._senses is not None:
            self._senses.reset(seed)
        return self._observer.observe(self._seen(plant_state, state), 0.0), {'state': state}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Apply ``action`` for 20 ms.

        Raises:
            ValueError: the action has another shape than the action space, or is not finite.
        """
        if np.shape(action) != self.action_space.shape:
            raise ValueError(f'the action {action} is of shape {np.shape(action)}, expected {self.action_space.shape}')
        if not np.isfinite(action).all():
            raise ValueError(f'the action {action} is not finite')
        plant_state = self.plant.advance(bounded(action, 1.0).astype(float) * self._scale)
        self._step += 1
        state = self.task.describe(plant_state, self._model)
        terms = self.task.reward_terms(state)
        failed = self.task.failed(state)
        info = {
            'agent': plant_state.agent.copy(), 'human': plant_state.human.copy(), 'applied': plant_state.applied.copy(),
            'reward_terms': terms, 'state': state, 'on_tray': self.task.on_tray(state), 'failed': failed}
        reward = sum(terms.values()) * self.task.reward_scale
        observation = self._observer.observe(self._seen(plant_state, state), POLICY_PERIOD)
        return observation, reward, failed, not failed and self._step >= self._steps, info

    def _seen(self, plant_state: PlantState, state: Any) -> Any:
        """The task's state as it is perceived."""
        return state if self._senses is None else self.task.describe(
            self._senses.perceive(plant_state), self._model)

    def close(self) -> None:
        """Let go of the plant."""
        self.plant.close()


def observation_space(task: Task) -> gymnasium.spaces.Box:
    """What a learner of ``task`` sees."""
    return gymnasium.spaces.Box(-OBSERVATION_BOUND, OBSERVATION_BOUND, (task.observed_size,), np.float32)


def action_space(task: Task) -> gymnasium.spaces.Box:
    """What a learner of ``task`` does."""
    return gymnasium.spaces.Box(-1.0, 1.0, (len(task.axes),), np.float32)
