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

"""Policies as people name them: a file, or the folder of a session or of a training run."""

import os
from collections.abc import Sequence
from pathlib import Path

from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control_learning.learner import Learner
from shared_control_learning.policy_file import POLICY_NAME, PolicyFileError, load_policy

from ..session.folder import SessionFolder
from .lerobot_policy import LeRobotPolicy

Policy = Learner | LeRobotPolicy
"""What acts alone: it has a task and ``act``."""


def load_policies(paths: Sequence[Path], lerobot_python: Path | None = None, task: Task = BALANCE,
                  ) -> dict[str, Policy]:
    """The policies, by their paths from the folder that they have in common.

    Args:
        lerobot_python: the Python that lerobot is installed for, to run policies that it has trained.
        task: what those were trained for.

    Raises:
        PolicyFileError: one is missing or unusable, or a folder has none.
        ValueError: one is given twice, or they are of several tasks.
    """
    absolute = [path.expanduser().resolve() for path in paths]
    places = [_place(path).resolve() for path in absolute]
    if twice := [place for place in places if places.count(place) > 1]:
        raise ValueError(f'the policy {twice[0]} is given twice, be it by its folder or by the file: name it once')
    root = os.path.commonpath([path.parent for path in absolute])
    policies = {str(path.relative_to(root)): _load(place, lerobot_python, task)
                for path, place in zip(absolute, places, strict=True)}
    if len({policy.task.name for policy in policies.values()}) > 1:
        tasks = ', '.join(f'{name}: {policy.task.name}' for name, policy in policies.items())
        raise ValueError(f'policies of several tasks are not one condition ({tasks}): test those of each task apart')
    return policies


def _load(place: Path, lerobot_python: Path | None, task: Task) -> Policy:
    if not LeRobotPolicy.is_at(place):
        return load_policy(place)
    if lerobot_python is None:
        raise ValueError(f'{place} is a policy of LeRobot: --lerobot-python FILE says which Python lerobot is '
                         'installed for')
    return LeRobotPolicy(place, lerobot_python, task)


def _place(path: Path) -> Path:
    """A policy's file, or the folder of one of LeRobot."""
    if not path.is_dir() or LeRobotPolicy.is_at(path):
        return path
    places = (path / POLICY_NAME, SessionFolder(path).policy)
    found = next((place for place in places if place.exists()), None)
    if found is None:
        raise PolicyFileError(f'no policy in {path}: expected {" or ".join(map(str, places))}')
    return found
