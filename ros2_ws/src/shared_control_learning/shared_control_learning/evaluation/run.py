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

"""The tests by name."""

from shared_control.control.references import FREQUENCIES
from shared_control.tasks.task import Task
from shared_control_sim.changes import CHANGES

from ..callbacks import Callbacks
from .evaluate import TEST_EPISODES, TEST_SEED, Act
from .perturbation import run_perturbation
from .randomized import run_randomized
from .result import ProtocolResult
from .trajectory import run_trajectory
from .transfer import run_transfer

PROTOCOLS = ('randomized', 'perturbation', 'trajectory', 'transfer')


def run_protocol(name: str, act: Act, task: Task, episodes: int = TEST_EPISODES, seed: int = TEST_SEED,
                 callbacks: Callbacks | None = None, physics: str = 'bullet') -> list[ProtocolResult]:
    """The results of a protocol: one, or one a frequency, or one a change of the arm.

    Args:
        name: one of :data:`PROTOCOLS`.
        act: the policy.
        task: what it was trained for.
        episodes, seed: of the randomised test, and that on other arms; the others have one episode that is always the
            same.
        callbacks: called for each episode.
        physics: what it is tested in (entry point of the group ``shared_control.worlds``).
    """
    if name == 'randomized':
        return [run_randomized(act, task, episodes, seed, callbacks, physics)]
    if name == 'transfer':
        return run_transfer(act, task, episodes, seed, callbacks, physics)
    if name == 'perturbation':
        return [run_perturbation(act, task, callbacks=callbacks, physics=physics)]
    return [run_trajectory(act, frequency, task, callbacks, physics) for frequency in FREQUENCIES]


def count_episodes(name: str, episodes: int = TEST_EPISODES) -> int:
    """How many episodes a protocol has."""
    return {'randomized': episodes, 'perturbation': 1, 'trajectory': len(FREQUENCIES),
            'transfer': len(CHANGES) * episodes}[name]
