"""How good a policy is on its own: the randomised test (4.2), and when it counts as skilled."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from shared_control.env import BalanceEnv
from shared_control.plant import PlantInterrupted
from shared_control.seeds import episode_seed
from shared_control.tasks.balance.settings import TaskSettings

from ..callbacks import Hooks
from ..record import EpisodeRecord, settled

Act = Callable[[np.ndarray], np.ndarray]
"""A policy: observation (3,) -> action (1,)."""

TEST_EPISODES = 20
TEST_SECONDS = 10.0
TEST_SEED = 424_242
"""Of the ball starts; another for each evaluation of a study."""
POSITION_ERROR_MAX = 0.02
"""Mean |position error| of a success, m."""
VELOCITY_MAX = 0.03
"""Mean |velocity| of a success, m/s."""
SUCCESSES_NEEDED = 19
"""Of 20 test episodes, in two evaluations in a row."""


@dataclass(frozen=True, eq=False)
class TestEpisode:
    """One episode alone."""

    __test__ = False  # nothing for pytest to collect

    position_error: np.ndarray
    """(steps,), m"""
    velocity: np.ndarray
    """(steps,), m/s"""
    fallen: bool

    @property
    def success(self) -> bool:
        """The ball was kept, and is at rest in the centre at the end."""
        return (not self.fallen and settled(self.position_error) < POSITION_ERROR_MAX
                and settled(self.velocity) < VELOCITY_MAX)


@dataclass(frozen=True)
class Evaluation:
    """A randomised test."""

    episodes: tuple[TestEpisode, ...]

    @property
    def successes(self) -> int:
        """Successful episodes."""
        return sum(episode.success for episode in self.episodes)

    @property
    def success_rate(self) -> float:
        """0..1"""
        return self.successes / len(self.episodes)

    @property
    def passed(self) -> bool:
        """19 of 20 (95 %) or more."""
        return self.success_rate >= SUCCESSES_NEEDED / TEST_EPISODES

    @property
    def mean_position_error(self) -> float:
        """Mean |position error| over the last 3 s of the episodes, m."""
        return float(np.mean([settled(episode.position_error) for episode in self.episodes]))

    @property
    def mean_velocity(self) -> float:
        """Mean |velocity| over the last 3 s of the episodes, m/s."""
        return float(np.mean([settled(episode.velocity) for episode in self.episodes]))


def test_settings(task: TaskSettings) -> TaskSettings:
    """The task as it is tested: 10 s an episode."""
    return replace(task, episode_seconds=TEST_SECONDS)


test_settings.__test__ = False  # type: ignore[attr-defined]


def evaluate(act: Act, env: BalanceEnv, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
             hooks: Hooks | None = None) -> Evaluation:
    """Test ``act`` in ``env`` (with :func:`test_settings`, and nobody at the keys).

    Args:
        seed: of the ball starts.
        hooks: are told of each episode.
    """
    hooks = hooks or Hooks()
    return Evaluation(tuple(
        run_test_episode(act, env, number, seed, hooks) for number in range(1, episodes + 1)))


def passes(act: Act, env: BalanceEnv, seed: int = TEST_SEED) -> bool:
    """Whether ``act`` succeeds in 19 of 20 episodes; stops as soon as the answer is known."""
    successes = failures = 0
    while successes < SUCCESSES_NEEDED and failures <= TEST_EPISODES - SUCCESSES_NEEDED:
        if run_test_episode(act, env, successes + failures + 1, seed, Hooks()).success:
            successes += 1
        else:
            failures += 1
    return successes == SUCCESSES_NEEDED


def run_test_episode(act: Act, env: BalanceEnv, number: int, seed: int, hooks: Hooks) -> TestEpisode:
    """Episode ``number`` (from 1) of the test ``seed``; begun anew when the plant was interrupted."""
    while True:
        record = EpisodeRecord(number, 'test')
        hooks.episode_started(record)
        try:
            _run(act, env, episode_seed(seed, number), record, hooks)
        except PlantInterrupted as error:
            hooks.interrupted(error)
            continue
        hooks.episode_tested(record)
        return TestEpisode(np.array(record.position_error), np.array(record.velocity), record.fallen)


def _run(act: Act, env: BalanceEnv, seed: int, record: EpisodeRecord, hooks: Hooks) -> None:
    observation, _ = env.reset(seed=seed)
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(act(observation))
        record.add(info)
        hooks.stepped(record)
        ended = terminated or truncated
