"""The test on a moving tray (4.6, Figs. 22-24): the arm follows a cosine, the ball starts in the centre."""

from dataclasses import replace

from shared_control.control.references import cosine_reference
from shared_control.plant import PlantState
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import PandaModel
from shared_control.tasks.balance.settings import DEFAULT_TASK, TaskSettings
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Hooks
from .evaluate import TEST_SEED, Act, run_test_episode
from .perturbation import CENTRE
from .recording import RecordingEnv
from .result import ProtocolResult

SECONDS = 20.0
"""Of the episode, s: five periods of the slowest reference. The thesis does not say."""


class DrivenPlant(LocalPlant):
    """A plant whose joints follow the cosine reference of ``frequency`` (Hz) instead of standing still."""

    def __init__(self, frequency: float, moment_limit: float):
        super().__init__(None, moment_limit, ball_start_range=CENTRE)
        self._reference = cosine_reference(PandaModel(), frequency, SECONDS, CONTROL_PERIOD)

    def reset(self, seed: int | None = None) -> PlantState:
        """See :class:`LocalPlant`."""
        self._tick = 0
        return super().reset(seed)

    def tick(self, m_y: float) -> None:
        """See :class:`LocalPlant`."""
        q, qd = self.world.joint_state()
        self.world.step(self.controller.torque(
            q, qd, self.world.effort, m_y, self._reference.q[self._tick], self._reference.qd[self._tick]))
        self._tick += 1


def run_trajectory(act: Act, frequency: float, task: TaskSettings = DEFAULT_TASK, hooks: Hooks | None = None,
                   ) -> ProtocolResult:
    """Test ``act`` alone in one episode of 20 s on a tray that moves at ``frequency`` (Hz).

    See :func:`run_randomized` for the other arguments; the thesis' frequencies are
    ``shared_control.control.references.FREQUENCIES``.
    """
    env = RecordingEnv(DrivenPlant(frequency, task.moment_limit), replace(task, episode_seconds=SECONDS))
    try:
        run_test_episode(act, env, 1, TEST_SEED, hooks or Hooks())
    finally:
        env.close()
    return env.result(f'trajectory {frequency:g} Hz')
