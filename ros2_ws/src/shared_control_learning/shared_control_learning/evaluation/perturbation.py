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

"""The deterministic test (4.3, Figs. 18, 19): the ball in the centre, and two pushes at the tray."""

from dataclasses import replace

import numpy as np
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Callbacks
from .evaluate import TEST_SEED, Act, run_test_episode
from .recording import RecordingEnv
from .result import ProtocolResult

SECONDS = 30.0
"""Length of the episode, s."""
PUSHES = ((5.0, 6.0), (10.0, 11.0))
"""From and to, s."""
FORCE = (50.0, 0.0, -50.0)
"""50 N along the horizontal axis of the task (base x) and the vertical one, at the tray's origin, N. The thesis does
not tell the signs; why these, see docs/reference/protocols.md."""


class PushedPlant(LocalPlant):
    """A plant whose tray is pushed with ``force`` (N, base axes) at fixed times of the episode."""

    def __init__(self, task: Task, force: tuple[float, float, float], physics: str = 'bullet'):
        super().__init__(task, physics=physics)
        self._goal = np.array(task.scene.home) + [*task.scene.goal, 0.0]
        self._force = np.array(force)

    def reset(self, seed: int | None = None) -> PlantState:
        """See :class:`LocalPlant`."""
        self._step = 0
        return super().reset(seed)

    def ball_start(self) -> np.ndarray:
        """The goal: the tray's centre, or where else the task has it."""
        return self._goal

    def advance(self, agent: np.ndarray) -> PlantState:
        """See :class:`LocalPlant`."""
        now = self._step * POLICY_PERIOD
        pushed = any(start <= now < end for start, end in PUSHES)
        self.world.push(self._force if pushed else np.zeros(3))
        self._step += 1
        return super().advance(agent)


def run_perturbation(act: Act, task: Task = BALANCE, force: tuple[float, float, float] = FORCE,
                     callbacks: Callbacks | None = None, physics: str = 'bullet') -> ProtocolResult:
    """Test ``act`` alone in one episode of 30 s in which the tray is pushed twice with ``force``.

    See :func:`run_randomized` for the other arguments.
    """
    env = RecordingEnv(PushedPlant(task, force, physics), replace(task, episode_seconds=SECONDS))
    try:
        run_test_episode(act, env, 1, TEST_SEED, callbacks or Callbacks())
    finally:
        env.close()
    return env.result('perturbation')
