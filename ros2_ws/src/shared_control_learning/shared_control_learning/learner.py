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

"""What a learner is to everything else: the learn loop, the agent's node, policy files, tests."""

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from shared_control.printable import ECHO_MAX, cut, escaped
from shared_control.tasks.task import Task

from .episode import Episode

if TYPE_CHECKING:
    import torch


class Learner(Protocol):
    """Learns a task episode by episode.

    What it does must follow from its seed and the episodes that it has learned from alone, so that one that was saved
    and loaded goes on as if it had never stopped.
    """

    name: str
    """Name of its preset."""
    task: Task
    settings: Any
    """A frozen dataclass of everything that can be set, kept with the policy."""
    seed: int
    episode: int
    """Episodes learned from so far."""

    def begin(self) -> int:
        """A new episode begins; gives its seed (31 bits), for plant and tutor."""

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """The action to try, not clipped; (n,) -> (k,)."""

    def act(self, observation: np.ndarray) -> np.ndarray:
        """The action without exploring, within -1..1; (n,) -> (k,)."""

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """Learn from a finished episode; gives figures by name, for a log."""

    def tensors(self) -> 'dict[str, torch.Tensor]':
        """All that it has learned and needs to go on, by name."""

    def restore(self, tensors: 'Mapping[str, torch.Tensor]') -> None:
        """Become the learner that gave these tensors.

        Raises:
            ValueError: these are not tensors of such a learner; the message names the one that is wrong.
        """


ROWS_MAX = 100_000
"""Most rows of what a learner remembers, and of what is read of it from a file; an episode of 15 s has 750."""


def check_tensors(tensors: 'Mapping[str, torch.Tensor]', like: 'Mapping[str, torch.Tensor]',
                  growing: Collection[str] = ()) -> None:
    """Check that tensors read from a file are of the names, shapes and types of a learner's own.

    Args:
        like: the learner's.
        growing: names of those that may have any number of rows up to :data:`ROWS_MAX`, all the same.

    Raises:
        ValueError: they are not; the message names one that is wrong.
    """
    if tensors.keys() != like.keys():
        others = ', '.join(sorted(tensors.keys() ^ like.keys()))
        raise ValueError(f'these tensors differ: {escaped(cut(others, ECHO_MAX))}; it should hold '
                         f'{", ".join(sorted(like))}')
    rows = min((len(tensors[name]) for name in growing if tensors[name].dim()), default=0)
    if rows > ROWS_MAX:
        raise ValueError(f'{", ".join(sorted(growing))} have {rows} rows, at most {ROWS_MAX} are read')
    for name, tensor in tensors.items():
        own = like[name]
        shape = (rows, *own.shape[1:]) if name in growing else tuple(own.shape)
        if tuple(tensor.shape) != shape or tensor.dtype != own.dtype:
            raise ValueError(f'{name} is {tensor.dtype} {tuple(tensor.shape)}, expected {own.dtype} {shape}')


class Snapshot:
    """What a learner has learned so far, to go back to.

    Args:
        learner: whose state is copied.
    """

    def __init__(self, learner: Learner):
        self._episode = learner.episode
        self._tensors = {name: tensor.clone() for name, tensor in learner.tensors().items()}

    def put_back(self, learner: Learner) -> None:
        """Make the learner what it was, as if it had learned nothing since."""
        learner.restore(self._tensors)
        learner.episode = self._episode
