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

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
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
