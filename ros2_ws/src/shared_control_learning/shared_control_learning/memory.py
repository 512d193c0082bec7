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

"""What a learner remembers of its episodes: the last rows of some arrays."""

from collections.abc import Mapping

import numpy as np
import torch

from .learner import ROWS_MAX


class Memory:
    """Arrays of as many rows each, by name; float32.

    Like a replay buffer of limited size it keeps the last :data:`~shared_control_learning.learner.ROWS_MAX` rows, so
    that a policy file holds no more of them than are read from one.

    Args:
        prefix: of the names of its tensors.
        columns: numbers in a row of each.
    """

    def __init__(self, prefix: str = 'memory.', /, **columns: int):
        self._prefix = prefix
        self._rows = {name: np.zeros((0, size), np.float32) for name, size in columns.items()}

    def __len__(self) -> int:
        return len(next(iter(self._rows.values())))

    def __contains__(self, name: object) -> bool:
        return name in self._rows

    def __getitem__(self, name: str) -> np.ndarray:
        return self._rows[name]

    def add(self, **rows: np.ndarray) -> None:
        """Append rows to every array; the oldest are forgotten when there are too many."""
        self._rows = {name: np.concatenate([own, rows[name].astype(np.float32)]) for name, own in self._rows.items()}
        self.keep_last(ROWS_MAX)

    def keep_last(self, rows: int) -> None:
        """Forget all rows but the last ones, 1 or more."""
        self._rows = {name: own[-rows:] for name, own in self._rows.items()}

    def tensors(self) -> dict[str, torch.Tensor]:
        """By name, for a policy file."""
        return {self._prefix + name: torch.tensor(own) for name, own in self._rows.items()}

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """Become the memory that gave these tensors, which :func:`.learner.check_tensors` has checked."""
        self._rows = {name: tensors[self._prefix + name].numpy().copy() for name in self._rows}
