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

"""The test on other arms: the randomised test again and again, with one thing otherwise each time."""

from collections.abc import Sequence

from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control_sim.changed_plant import ChangedPlant, senses_of
from shared_control_sim.changes import CHANGES, Change

from ..callbacks import Callbacks
from .evaluate import TEST_EPISODES, TEST_SEED, Act, as_tested, evaluate
from .recording import RecordingEnv
from .result import TRANSFER, ProtocolResult


def run_transfer(act: Act, task: Task = BALANCE, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
                 callbacks: Callbacks | None = None, physics: str = 'bullet',
                 changes: Sequence[Change] = CHANGES) -> list[ProtocolResult]:
    """Test ``act`` alone under each of ``changes``; a result for each, with the same ball starts.

    See :func:`run_randomized` for the other arguments.
    """
    results = []
    for change in changes:
        env = RecordingEnv(ChangedPlant(task, change, physics=physics), as_tested(task), senses_of(change))
        try:
            evaluate(act, env, episodes, seed, callbacks)
        finally:
            env.close()
        results.append(env.result(TRANSFER + change.name))
    return results
