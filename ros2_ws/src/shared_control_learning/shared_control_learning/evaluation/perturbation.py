"""The deterministic test (4.3, Figs. 18, 19): the ball in the centre, and two pushes at the tray."""

from dataclasses import replace

import numpy as np
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance.scene import TRAY_HOME_X
from shared_control.tasks.balance.settings import DEFAULT_TASK, TaskSettings
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Hooks
from .evaluate import TEST_SEED, Act, run_test_episode
from .recording import RecordingEnv
from .result import ProtocolResult

SECONDS = 30.0
"""Of the episode, s."""
PUSHES = ((5.0, 6.0), (10.0, 11.0))
"""From and to, s."""
FORCE = (50.0, 0.0, -50.0)
"""50 N along the horizontal axis of the task (base x) and the vertical one, at the tray's origin, N. The thesis does
not tell the signs; why these, see docs/protocols.md."""
CENTRE = (TRAY_HOME_X, TRAY_HOME_X)
"""A range of ball starts that is a point: the tray's centre."""


class PushedPlant(LocalPlant):
    """A plant whose tray is pushed with ``force`` (N, base axes) at fixed times of the episode."""

    def __init__(self, force: tuple[float, float, float], moment_limit: float):
        super().__init__(None, moment_limit, ball_start_range=CENTRE)
        self._force = np.array(force)

    def reset(self, seed: int | None = None) -> PlantState:
        """See :class:`LocalPlant`."""
        self._step = 0
        return super().reset(seed)

    def advance(self, m_y_agent: float) -> PlantState:
        """See :class:`LocalPlant`."""
        now = self._step * POLICY_PERIOD
        pushed = any(start <= now < end for start, end in PUSHES)
        self.world.push(self._force if pushed else np.zeros(3))
        self._step += 1
        return super().advance(m_y_agent)


def run_perturbation(act: Act, task: TaskSettings = DEFAULT_TASK, force: tuple[float, float, float] = FORCE,
                     hooks: Hooks | None = None) -> ProtocolResult:
    """Test ``act`` alone in one episode of 30 s in which the tray is pushed twice with ``force``.

    See :func:`run_randomized` for the other arguments.
    """
    env = RecordingEnv(PushedPlant(force, task.moment_limit), replace(task, episode_seconds=SECONDS))
    try:
        run_test_episode(act, env, 1, TEST_SEED, hooks or Hooks())
    finally:
        env.close()
    return env.result('perturbation')
