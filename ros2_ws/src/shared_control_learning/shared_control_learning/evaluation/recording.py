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

"""The environment of the tests, which writes down what they measure."""

from typing import Any

import numpy as np
from shared_control.env import Senses, SharedControlEnv
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.tasks.task import Task
from shared_control_sim.local_plant import LocalPlant

from .result import TRACKS, ProtocolResult


class RecordingEnv(SharedControlEnv):
    """A :class:`SharedControlEnv` on a plant in this process that keeps the tracks of all its episodes."""

    def __init__(self, plant: LocalPlant, task: Task, senses: Senses | None = None):
        super().__init__(plant, task, senses=senses)
        self._world = plant.world
        self._robot = RobotModel(plant.spec)
        self._episodes: list[list[tuple[float, ...]]] = []
        self._fallen: list[bool] = []
        self._is_signed = len(task.axes) == 1

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None,
              ) -> tuple[np.ndarray, dict[str, Any]]:
        """See :class:`SharedControlEnv`; a new row begins."""
        self._episodes.append([])
        self._fallen.append(False)
        return super().reset(seed=seed, options=options)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """See :class:`SharedControlEnv`."""
        result = super().step(action)
        info = result[-1]
        state = info['state']
        q, qd = self._world.joint_state()
        self._episodes[-1].append((
            state.position_error, state.velocity, self._velocity_error(self._robot.jacobian(q) @ qd, state.velocity),
            float(info['agent'][0]) if self._is_signed else float(np.linalg.norm(info['agent'])), state.manipulability))
        self._fallen[-1] = info['failed']
        return result

    def _velocity_error(self, tray: np.ndarray, ball: float) -> float:
        if self._is_signed:
            return float(tray[0]) - ball
        return float(np.linalg.norm(tray[:2] - self._world.ball_state()[2][:2]))

    def result(self, test: str) -> ProtocolResult:
        """All episodes so far, as the result of ``test``."""
        steps = round(self.task.episode_seconds / POLICY_PERIOD)
        tracks = np.full((len(TRACKS), len(self._episodes), steps), np.nan)
        for row, episode in enumerate(self._episodes):
            tracks[:, row, :len(episode)] = np.array(episode).T
        success = [self.task.succeeded(np.array(episode).T[0], np.array(episode).T[1], fallen)
                   for episode, fallen in zip(self._episodes, self._fallen, strict=True)]
        return ProtocolResult(
            test, np.arange(1, steps + 1) * POLICY_PERIOD, **dict(zip(TRACKS, tracks, strict=True)),
            fallen=np.array(self._fallen), success=np.array(success))
