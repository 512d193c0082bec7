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
        ValueError: one is given twice.
    """
    absolute = [path.expanduser().resolve() for path in paths]
    if len(set(absolute)) < len(absolute):
        raise ValueError(f'a policy is given twice: {", ".join(map(str, paths))}')
    root = os.path.commonpath([path.parent for path in absolute])
    return {str(path.relative_to(root)): _load(path, lerobot_python, task) for path in absolute}


def _load(path: Path, lerobot_python: Path | None, task: Task) -> Policy:
    if not LeRobotPolicy.is_at(path):
        return load_policy(_policy_file(path))
    if lerobot_python is None:
        raise ValueError(f'{path} is a policy of LeRobot: --lerobot-python FILE says which Python lerobot is installed '
                         'for')
    return LeRobotPolicy(path, lerobot_python, task)


def _policy_file(path: Path) -> Path:
    if not path.is_dir():
        return path
    places = (path / POLICY_NAME, SessionFolder(path).policy)
    found = next((place for place in places if place.exists()), None)
    if found is None:
        raise PolicyFileError(f'no policy in {path}: expected {" or ".join(map(str, places))}')
    return found
