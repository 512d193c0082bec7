"""The randomised test (4.2, Figs. 16, 17): the ball is dropped anywhere, 20 times for 10 s."""

from shared_control.tasks.balance.settings import DEFAULT_TASK, TaskSettings
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Hooks
from .evaluate import TEST_EPISODES, TEST_SEED, Act, evaluate, test_settings
from .recording import RecordingEnv
from .result import ProtocolResult


def run_randomized(act: Act, task: TaskSettings = DEFAULT_TASK, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
                   hooks: Hooks | None = None) -> ProtocolResult:
    """Test ``act`` alone, by :func:`shared_control_learning.evaluation.evaluate.evaluate`, on the PyBullet plant.

    Args:
        act: the policy, observation (3,) -> action (1,).
        task: what the policy was trained for: its observation and action scales.
        episodes: rows of the result.
        seed: of the ball starts.
        hooks: are told of each episode.
    """
    env = RecordingEnv(LocalPlant(None, task.moment_limit), test_settings(task))
    try:
        evaluate(act, env, episodes, seed, hooks)
    finally:
        env.close()
    return env.result('randomized')
