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

"""What ``gymnasium.make`` makes: a task's environment in this process."""

from typing import Any

from shared_control.env import SharedControlEnv
from shared_control.plugins import TASKS, load
from shared_control.teaching.tutors import make_tutor, tutor_named

from .local_plant import LocalPlant


def make_env(task: str, tutor: str | None = None, physics: str = 'bullet', human_only: bool = False,
             **settings: Any) -> SharedControlEnv:
    """The environment of the task called ``task``.

    Args:
        task: name (entry point of the group ``shared_control.tasks``).
        tutor: name of a simulated tutor (``expert``, ``crossover``, ...), of a family the individual of seed 0; nobody
            at the keys when None. Each reset is one more episode that they teach: who learns, or tires, does.
        physics: its name (entry point of the group ``shared_control.worlds``).
        human_only: the agent's moment is not applied.
        settings: of the task, as its class has them (``episode_seconds``, ``action_scale``, ...).

    Raises:
        ValueError: there is no task, profile or world of that name, a setting cannot be, or there is a tutor and
            the task has other axes than tutors know.
        TypeError: the task has no such setting.
        ImportError: the world is not installed; the message says what to install.
    """
    chosen = load(TASKS, task)(**settings)
    person = None if tutor is None else make_tutor(tutor_named(tutor), chosen)
    return SharedControlEnv(LocalPlant(chosen, person, physics), chosen, human_only)
