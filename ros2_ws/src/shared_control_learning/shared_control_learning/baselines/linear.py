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

"""What all baselines with the policy ``w s + b`` have in common."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task

from ..episode import Episode
from ..learner import check_tensors


class LinearLearner:
    """A :class:`~shared_control_learning.learner.Learner` with a linear policy, which it neither explores nor changes.

    Args:
        name: of the preset.
        task: what it does.
        settings: how.
        seed: of everything random.
    """

    def __init__(self, name: str, task: Task, settings: Any, seed: int = 0):
        self.name, self.task, self.settings, self.seed = name, task, settings, seed
        self.episode = 0
        self.weights = np.zeros((len(task.axes), task.observed_size))
        """(k, n), actions per unit of the observation"""
        self.bias = np.zeros(len(task.axes))
        """(k,), actions"""

    def begin(self) -> int:
        """See :class:`Learner`."""
        return episode_seed(self.seed, self.episode + 1)

    def act(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return (self.weights @ observation + self.bias).clip(-1.0, 1.0).astype(np.float32)

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return self.act(observation)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`."""
        self.episode += 1
        return {}

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`."""
        return {'weights': torch.tensor(self.weights), 'bias': torch.tensor(self.bias)}

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        check_tensors(tensors, LinearLearner.tensors(self))
        self.weights, self.bias = (tensors[name].numpy().copy() for name in ('weights', 'bias'))
