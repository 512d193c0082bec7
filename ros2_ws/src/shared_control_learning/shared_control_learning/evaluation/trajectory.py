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

"""The test on a moving tray (4.6, Figs. 22-24): the arm follows a cosine, the ball starts in the centre."""

from dataclasses import replace

import numpy as np
from shared_control.control.references import cosine_reference
from shared_control.plant import PlantState
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Callbacks
from .evaluate import TEST_SEED, Act, run_test_episode
from .recording import RecordingEnv
from .result import ProtocolResult

SECONDS = 20.0
"""Length of the episode, s: five periods of the slowest reference. The thesis does not say."""


class DrivenPlant(LocalPlant):
    """A plant whose joints follow the cosine reference of ``frequency`` (Hz) instead of standing still."""

    def __init__(self, task: Task, frequency: float, physics: str = 'bullet'):
        super().__init__(task, physics=physics)
        self._goal = np.array(task.scene.home) + [*task.scene.goal, 0.0]
        self._reference = cosine_reference(RobotModel(self.spec), frequency, SECONDS, CONTROL_PERIOD)

    def reset(self, seed: int | None = None) -> PlantState:
        """See :class:`LocalPlant`."""
        self._tick = 0
        return super().reset(seed)

    def ball_start(self) -> np.ndarray:
        """The goal: the tray's centre, or where else the task has it."""
        return self._goal

    def tick(self, moment: np.ndarray) -> None:
        """See :class:`LocalPlant`."""
        q, qd = self.world.joint_state()
        self.world.step(self.controller.torque(
            q, qd, self.world.effort, moment, self._reference.q[self._tick], self._reference.qd[self._tick]))
        self._tick += 1


def run_trajectory(act: Act, frequency: float, task: Task = BALANCE, callbacks: Callbacks | None = None,
                   physics: str = 'bullet') -> ProtocolResult:
    """Test ``act`` alone in one episode of 20 s on a tray that moves at ``frequency`` (Hz).

    See :func:`run_randomized` for the other arguments; the thesis' frequencies are
    ``shared_control.control.references.FREQUENCIES``.
    """
    env = RecordingEnv(DrivenPlant(task, frequency, physics), replace(task, episode_seconds=SECONDS))
    try:
        run_test_episode(act, env, 1, TEST_SEED, callbacks or Callbacks())
    finally:
        env.close()
    return env.result(f'trajectory {frequency:g} Hz')
