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

"""How good a policy is on its own: the randomised test (4.2), and when it counts as skilled."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from shared_control.env import SharedControlEnv
from shared_control.plant import PlantInterrupted
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task, settled

from ..callbacks import Callbacks
from ..episode import Episode
from ..learn import run_episode

Act = Callable[[np.ndarray], np.ndarray]
"""A policy: observation (n,) -> action (k,)."""

TEST_EPISODES = 20
TEST_SEED = 424_242
"""Seed of the ball starts; another for each evaluation of a study."""
SUCCESSES_NEEDED = 19
"""So many of 20 test episodes, in two evaluations in a row."""


@dataclass(frozen=True)
class Evaluation:
    """A randomised test."""

    episodes: tuple[Episode, ...]

    @property
    def successes(self) -> int:
        """Successful episodes."""
        return sum(episode.success for episode in self.episodes)

    @property
    def success_rate(self) -> float:
        """Share of episodes that succeeded, 0 to 1."""
        return self.successes / len(self.episodes)

    @property
    def passed(self) -> bool:
        """19 of 20 (95 %) or more."""
        return self.success_rate >= SUCCESSES_NEEDED / TEST_EPISODES

    @property
    def mean_position_error(self) -> float:
        """Mean |position error| over the last 3 s of the episodes, m."""
        return float(np.mean([settled(np.array(episode.position_error)) for episode in self.episodes]))

    @property
    def mean_velocity(self) -> float:
        """Mean |velocity| over the last 3 s of the episodes, m/s."""
        return float(np.mean([settled(np.array(episode.velocity)) for episode in self.episodes]))


def as_tested(task: Task) -> Task:
    """The task with episodes as long as those of the test."""
    return replace(task, episode_seconds=task.test_seconds)


def evaluate(act: Act, env: SharedControlEnv, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
             callbacks: Callbacks | None = None) -> Evaluation:
    """Test ``act`` in ``env`` (of a task :func:`as_tested`, with nobody at the keys).

    Args:
        seed: of the ball starts.
        callbacks: called for each episode.
    """
    callbacks = callbacks or Callbacks()
    return Evaluation(tuple(
        run_test_episode(act, env, number, seed, callbacks) for number in range(1, episodes + 1)))


def passes(act: Act, env: SharedControlEnv, seed: int = TEST_SEED) -> bool:
    """Whether ``act`` succeeds in 19 of 20 episodes; stops as soon as the answer is known."""
    successes = failures = 0
    while successes < SUCCESSES_NEEDED and failures <= TEST_EPISODES - SUCCESSES_NEEDED:
        if run_test_episode(act, env, successes + failures + 1, seed, Callbacks()).success:
            successes += 1
        else:
            failures += 1
    return successes == SUCCESSES_NEEDED


def run_test_episode(act: Act, env: SharedControlEnv, number: int, seed: int, callbacks: Callbacks) -> Episode:
    """Episode ``number`` (from 1) of the test ``seed``; begun anew when the plant was interrupted."""
    while True:
        episode = Episode(env.task, number, 'test')
        callbacks.episode_started(episode)
        try:
            run_episode(act, env, episode_seed(seed, number), episode, callbacks)
        except PlantInterrupted as error:
            callbacks.interrupted(error)
            continue
        callbacks.episode_tested(episode)
        return episode
