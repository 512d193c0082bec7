"""How good a policy is on its own: the randomised test (4.2), and when it counts as skilled."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..envs.balance_env import BalanceEnv
from ..envs.plant import POLICY_PERIOD, PlantInterrupted
from ..task.settings import TaskSettings
from .episode_ppo import episode_seed

Act = Callable[[np.ndarray], np.ndarray]
"""A policy: observation (3,) -> action (1,)."""

TEST_EPISODES = 20
TEST_SECONDS = 10.0
TEST_SEED = 424_242
"""Of the ball starts; another for each evaluation of a study."""
SETTLED_SECONDS = 3.0
"""The end of an episode, over which a settled ball is judged, s."""
POSITION_ERROR_MAX = 0.02
"""Mean |position error| of a success, m."""
VELOCITY_MAX = 0.03
"""Mean |velocity| of a success, m/s."""
SUCCESSES_NEEDED = 19
"""Of 20 test episodes, in two evaluations in a row."""


def settled(values: np.ndarray) -> float:
    """Mean magnitude over the last 3 s of a series at the policy's rate."""
    return float(np.abs(values[-round(SETTLED_SECONDS / POLICY_PERIOD):]).mean())


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
             on_episode: Callable[[int, TestEpisode], None] = lambda *_: None) -> Evaluation:
    """Test ``act`` in ``env`` (with :func:`test_settings`, and nobody at the keys).

    Args:
        seed: of the ball starts.
        on_episode: is told each episode's number (from 1) and outcome.
    """
    results = []
    for number in range(1, episodes + 1):
        results.append(run_test_episode(act, env, episode_seed(seed, number)))
        on_episode(number, results[-1])
    return Evaluation(tuple(results))


def passes(act: Act, env: BalanceEnv, seed: int = TEST_SEED) -> bool:
    """Whether ``act`` succeeds in 19 of 20 episodes; stops as soon as the answer is known."""
    successes = failures = 0
    for number in range(1, TEST_EPISODES + 1):
        if run_test_episode(act, env, episode_seed(seed, number)).success:
            successes += 1
        else:
            failures += 1
        if successes == SUCCESSES_NEEDED or failures > TEST_EPISODES - SUCCESSES_NEEDED:
            break
    return successes == SUCCESSES_NEEDED


def run_test_episode(act: Act, env: BalanceEnv, seed: int) -> TestEpisode:
    """One episode of a test, tried again when the plant was interrupted."""
    while True:
        try:
            return _run(act, env, seed)
        except PlantInterrupted:
            continue


def _run(act: Act, env: BalanceEnv, seed: int) -> TestEpisode:
    observation, _ = env.reset(seed=seed)
    errors, velocities = [], []
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(act(observation))
        errors.append(info['state'].position_error)
        velocities.append(info['state'].ball_velocity)
        ended = terminated or truncated
    return TestEpisode(np.array(errors), np.array(velocities), terminated)
