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

"""What baselines need of a task. Quick to load, so that a task is refused before anything begins."""

from shared_control.tasks.balance import Balance
from shared_control.tasks.task import Task


def scales_of(name: str, task: Task) -> tuple[float, float, float]:
    """What position error, velocity and pitch of ``balance`` are divided by.

    Raises:
        ValueError: it is another task, or its observation has no fixed scales.
    """
    if not isinstance(task, Balance) or task.observation_scales is None:
        raise ValueError(f'{name} knows the task balance, with its usual observation, not {task.name}')
    return task.observation_scales


def check_errors(name: str, task: Task) -> None:
    """Whether a task observes position errors, and no integrals of them.

    Raises:
        ValueError: it does not.
    """
    if not task.errors or task.integrates:
        raise ValueError(f'{name} needs a task that observes position errors and no integrals of them; '
                         f'{task.name} is none')
