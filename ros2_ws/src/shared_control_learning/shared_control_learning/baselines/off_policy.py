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

"""What the off-policy baselines have in common: Stable-Baselines3's updates, and minibatches with interventions."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, cast

import numpy as np
import torch
from shared_control.env import action_space, observation_space
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task
from stable_baselines3.common.buffers import ReplayBuffer, ReplayBufferSamples
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm

from ..episode import Episode
from ..learner import check_tensors
from ..memory import Memory
from ..noise import CorrelatedNoise
from ..optimizer_state import adam_tensors
from ..ppo import Spaces
from .presets import OffPolicySettings


class OffPolicyLearner:
    """A :class:`Learner` that replays the steps so far, half of every minibatch those in which the person intervened.

    Symmetric sampling, as RLPD (Ball et al., 2023) samples demonstrations. The action of a step is the moment that
    counted, whoever gave it, within what the policy can do (-1..1): after a person's it is theirs. All gradient steps
    are done after the episode. The oldest steps are forgotten in the end (:class:`.memory.Memory`).

    Args:
        name: of the preset.
        task: what it learns.
        settings: how.
        seed: of the first weights and of everything random after them.
    """

    def __init__(self, name: str, task: Task, settings: OffPolicySettings, seed: int = 0):
        self.name, self.task, self.settings, self.seed = name, task, settings, seed
        self.episode = 0
        n, k = task.observed_size, len(task.axes)
        self.replay = Replay(Memory(observations=n, actions=k, own_actions=k, next=n, ended=1, rewards=1, intervened=1))
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            self._algorithm = self.make(Spaces(observation_space(task), action_space(task)), {
                'learning_rate': settings.learning_rate, 'buffer_size': 1, 'batch_size': settings.batch_size,
                'gamma': settings.gamma, 'device': 'cpu', 'policy_kwargs': {'net_arch': list(settings.hidden)}})
        self._algorithm.set_logger(Logger(None, []))
        self._algorithm.replay_buffer = cast('ReplayBuffer', self.replay)  # sample() is all that train() calls
        self._noise = CorrelatedNoise(k, settings.noise_seconds)

    @abstractmethod
    def make(self, spaces: Spaces, arguments: dict[str, Any]) -> OffPolicyAlgorithm:
        """Stable-Baselines3's algorithm, made with ``arguments`` among others."""

    @abstractmethod
    def explored(self, observations: torch.Tensor, noise: torch.Tensor) -> torch.Tensor:
        """What it tries, (1, k), when it sees ``observations``, (1, n); ``noise``: standard normal, (k,)."""

    @abstractmethod
    def optimized(self) -> list[tuple[str, torch.optim.Optimizer, list[tuple[str, torch.Tensor]]]]:
        """Name, optimizer and parameters of everything that it optimizes."""

    def begin(self) -> int:
        """See :class:`Learner`."""
        seed = episode_seed(self.seed, self.episode + 1)
        self._noise.begin(seed)
        return seed

    @torch.no_grad()
    def act(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return self._algorithm.policy._predict(torch.as_tensor(observation)[None], deterministic=True)[0].numpy()

    @torch.no_grad()
    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return self.explored(torch.as_tensor(observation)[None], self._noise.next())[0].numpy()

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`."""
        self.replay.add(episode)
        algorithm, seed = self._algorithm, episode_seed(self.seed, self.episode + 1)
        algorithm._n_updates = 0  # so that a learner that was saved goes on alike
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            self.replay.random = np.random.default_rng(seed)
            algorithm.train(round(self.settings.updates_a_step * len(episode)), self.settings.batch_size)
        algorithm.policy.set_training_mode(False)
        self.episode += 1
        figures = {name: float(value) for name, value in algorithm.logger.name_to_value.items()}
        algorithm.logger.dump()  # which forgets them
        return figures

    def _own(self) -> dict[str, torch.Tensor]:
        """Copying into these changes the learner."""
        tensors = {f'policy.{name}': tensor for name, tensor in self._algorithm.policy.state_dict().items()}
        for name, optimizer, parameters in self.optimized():
            tensors |= {f'{name}.{key}': tensor for key, tensor in adam_tensors(optimizer, parameters).items()}
        return tensors

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: weights, Adam's moments, and the steps that it replays."""
        return {name: tensor.detach() for name, tensor in self._own().items()} | self.replay.memory.tensors()

    @torch.no_grad()
    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        check_tensors(tensors, self.tensors(), self.replay.memory.tensors().keys())
        for name, own in self._own().items():
            own.copy_(tensors[name])
        self.replay.memory.restore(tensors)


class Replay:
    """Minibatches for Stable-Baselines3's ``train``.

    Args:
        memory: of the steps.
    """

    def __init__(self, memory: Memory):
        self.memory = memory
        self.random = np.random.default_rng()
        self.drawn = np.zeros(0, int)
        """Rows of the last minibatch."""

    def add(self, episode: Episode) -> None:
        """Remember the steps of an episode."""
        seen = np.array([*episode.observations, episode.last_observation])
        ended = np.zeros((len(episode), 1))
        ended[-1] = episode.failed
        self.memory.add(
            observations=seen[:-1], next=seen[1:], ended=ended, rewards=np.array(episode.rewards)[:, np.newaxis],
            actions=episode.applied_actions.clip(-1.0, 1.0),
            own_actions=np.array(episode.actions).clip(-1.0, 1.0),
            intervened=episode.held[:, np.newaxis])

    def sample(self, batch_size: int, env: Any = None) -> ReplayBufferSamples:
        """As ``ReplayBuffer.sample``; half of the rows are interventions, when there are any."""
        rows = self.random.integers(0, len(self.memory), batch_size)
        intervened = np.flatnonzero(self.memory['intervened'])
        if len(intervened):
            rows[:batch_size // 2] = self.random.choice(intervened, batch_size // 2)
        self.drawn = rows
        return ReplayBufferSamples(*(torch.as_tensor(self.memory[name][rows]) for name in (
            'observations', 'actions', 'next', 'ended', 'rewards')))

    def rows(self, name: str) -> torch.Tensor:
        """Another column of the last minibatch."""
        return torch.as_tensor(self.memory[name][self.drawn])
