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

"""A policy that LeRobot has trained on an exported data set, for the tests of ours.

It runs in a process of lerobot's own Python (:mod:`.lerobot_server`), since lerobot asks for other versions of torch
and Python than this project.
"""

import json
import subprocess
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

import numpy as np
from shared_control.processes import leave_with_the_parent
from shared_control.tasks.task import Task

from ..export.frames import action_rows

SERVER = Path(__file__).with_name('lerobot_server.py')


class LeRobotPolicy:
    """The policy of a folder, acting as a learner does.

    Args:
        folder: ``pretrained_model/`` of a training run of lerobot.
        python: the Python that lerobot is installed for.
        task: what it was trained for.

    Raises:
        ValueError: it cannot be loaded; the message has the last line of the reason.
    """

    @staticmethod
    def is_at(folder: Path) -> bool:
        """Whether a folder holds a policy of LeRobot."""
        return (folder / 'config.json').is_file() and (folder / 'model.safetensors').is_file()

    def __init__(self, folder: Path, python: Path, task: Task):
        self.task = task
        self._folder = folder
        # No pipe: nobody reads what libraries warn of, and a full one holds the process up.
        self._said = TemporaryFile('w+', encoding='utf-8', errors='replace')  # noqa: SIM115 - closed with the process
        self._process = subprocess.Popen(
            [python, SERVER, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said, text=True,
            preexec_fn=leave_with_the_parent)
        self._answer()

    def act(self, observation: np.ndarray) -> np.ndarray:
        """The action, (k,), within -1..1, for what the task shows a learner, (observation_size,)."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(observation.tolist()) + '\n')
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # the answer says why
        answer = dict(zip(action_rows(self.task), json.loads(self._answer()), strict=True))
        moment = np.array([answer[row] for row in self.task.axes])
        return np.clip(moment / self.task.scale, -1.0, 1.0).astype(np.float32)

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()
        self._said.close()

    def _answer(self) -> str:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            self._process.wait()
            raise ValueError(f'LeRobot cannot use the policy in {self._folder}: {_last_line(self._said)}')
        return line


def _last_line(said: IO[str]) -> str:
    said.seek(0)
    last = 'no reason given'
    for line in said:
        last = line.strip() or last
    return last
