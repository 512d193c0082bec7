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

"""The randomised test (4.2, Figs. 16, 17): the ball is dropped anywhere, 20 times for 10 s."""

from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control_sim.local_plant import LocalPlant

from ..callbacks import Callbacks
from .evaluate import TEST_EPISODES, TEST_SEED, Act, as_tested, evaluate
from .recording import RecordingEnv
from .result import ProtocolResult


def run_randomized(act: Act, task: Task = BALANCE, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
                   callbacks: Callbacks | None = None, physics: str = 'bullet') -> ProtocolResult:
    """Test ``act`` alone, by :func:`shared_control_learning.evaluation.evaluate.evaluate` in this process.

    Args:
        act: the policy, observation (n,) -> action (k,).
        task: what the policy was trained for: its observation and action scales.
        episodes: rows of the result.
        seed: of the ball starts.
        callbacks: called for each episode.
        physics: what it is tested in (entry point of the group ``shared_control.worlds``).
    """
    env = RecordingEnv(LocalPlant(task, physics=physics), as_tested(task))
    try:
        evaluate(act, env, episodes, seed, callbacks)
    finally:
        env.close()
    return env.result('randomized')
