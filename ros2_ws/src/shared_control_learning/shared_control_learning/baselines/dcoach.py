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

"""D-COACH as published."""

from collections.abc import Mapping

import numpy as np
import torch
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task

from ..episode import Episode
from ..learner import check_tensors
from ..memory import Memory
from .presets import DCoachSettings


class DCoach:
    """R. Perez-Dattari, C. Celemin, J. Ruiz-del-Solar and J. Kober, ISER 2018, Algorithm 1. A :class:`Learner`.

    While the person corrects, with the sign h, the policy is taught by gradient descent to do ``a + e h`` instead of
    the a that it did, and a minibatch of earlier corrections with it; every b steps it is taught such a minibatch in
    any case. There is neither a reward nor exploring. Unlike there, the steps of an episode are learned from when it is
    over; what the robot did is what it did at the time.

    Args:
        name: of the preset.
        task: what it learns.
        settings: how.
        seed: of the first weights and the minibatches.
    """

    def __init__(self, name: str, task: Task, settings: DCoachSettings, seed: int = 0):
        self.name, self.task, self.settings, self.seed = name, task, settings, seed
        self.episode = 0
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            layers: list[torch.nn.Module] = []
            width = task.observed_size
            for units in settings.hidden:
                layers += [torch.nn.Linear(width, units), torch.nn.ReLU()]
                width = units
            self._policy = torch.nn.Sequential(*layers, torch.nn.Linear(width, len(task.axes)), torch.nn.Tanh())
        self._optimizer = torch.optim.SGD(self._policy.parameters(), settings.learning_rate)
        self._corrections = Memory(observations=task.observed_size, labels=len(task.axes))

    def begin(self) -> int:
        """See :class:`Learner`."""
        return episode_seed(self.seed, self.episode + 1)

    @torch.no_grad()
    def act(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return self._policy(torch.as_tensor(observation)).numpy()

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return self.act(observation)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`."""
        settings = self.settings
        random = np.random.default_rng(episode_seed(self.seed, self.episode + 1))
        observations, advice = np.array(episode.observations), np.sign(episode.human)
        labels = (np.array(episode.actions) + settings.error * advice).clip(-1.0, 1.0).astype(np.float32)
        for step in range(len(episode)):
            if advice[step].any():
                now = slice(step, step + 1)
                self._descend(observations[now], labels[now])
                self._replay(random)
                self._corrections.add(observations=observations[now], labels=labels[now])
                self._corrections.keep_last(settings.memory)
            if step % settings.replay_every == 0:
                self._replay(random)
        self.episode += 1
        return {'train/corrections': float(len(self._corrections))}

    def _replay(self, random: np.random.Generator) -> None:
        if len(self._corrections):
            rows = random.integers(0, len(self._corrections), self.settings.batch_size)
            self._descend(self._corrections['observations'][rows], self._corrections['labels'][rows])

    def _descend(self, observations: np.ndarray, labels: np.ndarray) -> None:
        loss = torch.nn.functional.mse_loss(self._policy(torch.as_tensor(observations)), torch.as_tensor(labels))
        self._optimizer.zero_grad()
        loss.backward()
        self._optimizer.step()

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: weights, and the corrections that are remembered."""
        return {f'policy.{name}': tensor for name, tensor in self._policy.state_dict().items()} | (
            self._corrections.tensors())

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        own = self.tensors()
        check_tensors(tensors, own, self._corrections.tensors().keys())
        for name, tensor in self._policy.state_dict().items():
            tensor.copy_(tensors[f'policy.{name}'])
        self._corrections.restore(tensors)
