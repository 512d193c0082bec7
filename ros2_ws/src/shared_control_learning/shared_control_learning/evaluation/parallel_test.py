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

"""The test of a policy by several processes: the same episodes, and so the same answer, sooner."""

import multiprocessing
import os
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

from shared_control.env import SharedControlEnv
from shared_control.processes import begin_worker
from shared_control.tasks.task import Task
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Callbacks
from ..learner import Learner
from ..policy_file import SUFFIX, load_policy, save_policy
from .evaluate import SUCCESSES_NEEDED, TEST_EPISODES, as_tested, passes, run_test_episode

MOST = 5
"""Processes: each costs 300 MB and the seconds of its start, and a test has 20 episodes."""

AHEAD = 2
"""Episodes that a helper has at most, so that it need not wait for the next while this process does one of its own."""


class ParallelTest:
    """Helpers of this process, which begin to start at once and end with it.

    Args:
        task: of the learners that will be tested.
        physics: its name.
        processes: how many test, this one included: two or more, of which :data:`MOST` are used.
    """

    def __init__(self, task: Task, physics: str, processes: int):
        self._physics = physics
        helpers = min(processes, MOST) - 1
        self._pool = ProcessPoolExecutor(
            helpers, multiprocessing.get_context('spawn'), begin_worker, (os.getpid(),))
        self._folder = TemporaryDirectory(prefix='shared_control_')
        self._names = count()
        self._starting = [self._pool.submit(_warm_up, task, physics) for _ in range(helpers)]

    def passes(self, learner: Learner, env: SharedControlEnv, seed: int) -> bool:
        """As :func:`.evaluate.passes`; ``env`` is this process's own, which takes its share of the episodes.

        When a helper was killed, this process does it all.
        """
        policy = Path(self._folder.name) / f'{next(self._names)}{SUFFIX}'
        save_policy(learner, policy)
        try:
            return self._passes(learner, env, seed, policy)
        except BrokenProcessPool:
            return passes(learner.act, env, seed)

    def _passes(self, learner: Learner, env: SharedControlEnv, seed: int, policy: Path) -> bool:
        left = list(range(TEST_EPISODES, 0, -1))
        running: set[Future[bool]] = set()
        failures = 0
        while left or running:
            while left and len(running) < self._ready * AHEAD:
                running.add(self._pool.submit(_succeeds, policy, self._physics, seed, left.pop()))
            if left:
                failures += not run_test_episode(learner.act, env, left.pop(), seed, Callbacks()).success
            done, running = wait(running, 0.0 if left else None, FIRST_COMPLETED)
            failures += sum(not future.result() for future in done)
            if failures > TEST_EPISODES - SUCCESSES_NEEDED:
                return False
        return True

    @property
    def _ready(self) -> int:
        """How many helpers have started."""
        return sum(future.done() for future in self._starting)

    def close(self) -> None:
        """End the helpers."""
        self._pool.shutdown(cancel_futures=True)
        self._folder.cleanup()


def _warm_up(task: Task, physics: str) -> None:
    """Import and build what takes seconds."""
    _test_env(task, physics)


@lru_cache(maxsize=1)
def _test_env(task: Task, physics: str) -> SharedControlEnv:
    return SharedControlEnv(LocalPlant(task, physics=physics), as_tested(task))


@lru_cache(maxsize=1)
def _learner(policy: Path) -> Learner:
    return load_policy(policy)


def _succeeds(policy: Path, physics: str, seed: int, number: int) -> bool:
    """Whether the policy in a file succeeds in an episode; in a helper."""
    learner = _learner(policy)
    return run_test_episode(learner.act, _test_env(learner.task, physics), number, seed, Callbacks()).success
