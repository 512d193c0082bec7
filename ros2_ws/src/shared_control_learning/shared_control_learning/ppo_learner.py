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

"""PPO with one update an episode; with a person's corrections in its loss, when it is coached."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
import torch
from shared_control.bounds import bounded
from shared_control.env import action_space, observation_space
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.logger import Logger
from torch.nn.functional import linear

from .corrections import Corrections, find_corrections
from .episode import Episode
from .learner import check_tensors
from .noise import CorrelatedNoise
from .optimizer_state import adam_tensors
from .ppo import ExtraLossPPO, Spaces
from .settings import PpoLearnerSettings


class PpoLearner:
    """A :class:`Learner` whose update is that of Stable-Baselines3's PPO over one episode, however long that is.

    With coaching it adds ``lambda |pi(s) - y|^2``, the weighted mean over the corrections of the last episodes, to
    PPO's loss: corrective advice as labels of a network, COACH (Celemin and Ruiz-del-Solar, 2019) and D-COACH
    (Perez-Dattari et al., 2018), which also credit advice to a window of the past, and replay it; beside a reward, as
    PVP (Peng et al., 2023) does. Without corrections it is PPO, to the bit.

    Args:
        name: of the settings.
        task: what it learns.
        settings: how.
        seed: of the first weights and of everything random after them.
    """

    def __init__(self, name: str, task: Task, settings: PpoLearnerSettings, seed: int = 0):
        self.name, self.task, self.settings, self.seed = name, task, settings, seed
        self.episode = 0
        ppo = settings.ppo
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            self._ppo = ExtraLossPPO(
                'MlpPolicy', Spaces(observation_space(task), action_space(task)),
                learning_rate=lambda _: ppo.learning_rate_in(self.episode + 1), n_steps=ppo.batch_size,
                batch_size=ppo.batch_size, n_epochs=ppo.epochs, gamma=ppo.gamma, gae_lambda=ppo.gae_lambda,
                clip_range=ppo.clip_range, ent_coef=ppo.entropy_weight, vf_coef=ppo.value_weight,
                max_grad_norm=ppo.max_gradient_norm, device='cpu',
                policy_kwargs={'net_arch': {'pi': list(ppo.hidden), 'vf': list(ppo.value_hidden)},
                               'log_std_init': float(np.log(ppo.initial_std))})
        self._ppo.rate_end = ppo.learning_rate_end
        self._ppo.set_logger(Logger(None, []))
        self.policy = self._ppo.policy
        self.policy.log_std.requires_grad_(ppo.std_decay is None)
        self._layers = [(layer.weight, layer.bias)
                        for layer in (*self.policy.mlp_extractor.policy_net, self.policy.action_net)
                        if isinstance(layer, torch.nn.Linear)]
        # The same numbers without gradients: switching those off and on would take as long as the rest of an action.
        self._detached = [(weight.detach(), bias.detach()) for weight, bias in self._layers]
        self.corrections = Corrections.none(task)
        """Those of the last episodes."""
        self._noise = CorrelatedNoise(len(task.axes), ppo.noise_seconds)

    def begin(self) -> int:
        """See :class:`Learner`."""
        seed = episode_seed(self.seed, self.episode + 1)
        self._noise.begin(seed)
        std = self.settings.ppo.std_in(self.episode + 1)
        if std is not None:
            self.policy.log_std.data.fill_(math.log(std))
        return seed

    @torch.no_grad()
    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`.

        Every action is Gaussian, as PPO takes it to be; those that follow each other may be correlated (Hollenstein
        et al., 2024), since a tray does not follow what changes its sign every 20 ms.
        """
        return (self.means(torch.as_tensor(observation)) + self.policy.log_std.exp() * self._noise.next()).numpy()

    def act(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`."""
        return bounded(_means(self._detached, torch.from_numpy(observation)).numpy(), 1.0)

    def means(self, observations: torch.Tensor) -> torch.Tensor:
        """Means of the Gaussian policy, not clipped; (..., n) -> (..., k)."""
        return _means(self._layers, observations)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`."""
        self._ppo.extra_loss = self._coaching_loss(episode)
        self._ppo.rollout_buffer = self._rollout(episode)
        self._ppo.num_timesteps += len(episode)
        with _numpy_seeded(episode_seed(self.seed, self.episode + 1)):  # the order of the minibatches
            self._ppo.train()
        self.episode += 1
        figures = {name: float(value) for name, value in self._ppo.logger.name_to_value.items()}
        self._ppo.logger.dump()  # which forgets them
        return {**figures, 'train/corrections': float(len(self.corrections))}

    def _coaching_loss(self, episode: Episode) -> Callable[[], torch.Tensor] | None:
        """What the corrections add to the loss; None when they do not count."""
        coaching = self.settings.coaching
        if coaching is None:
            return None
        number = self.episode + 1
        with torch.no_grad():
            means = self.means(torch.as_tensor(np.array(episode.observations))).clamp(-1.0, 1.0).numpy()
        found = find_corrections(episode, number, means, coaching)
        known = self.corrections = self.corrections.since(number - coaching.memory_episodes + 1).followed_by(found)
        weight = coaching.weight_in(number)
        if weight == 0.0 or not len(known):
            return None

        def loss() -> torch.Tensor:
            squares = ((self.means(known.observations) - known.labels) ** 2).sum(dim=1, keepdim=True)
            return weight * ((known.weights * squares).sum() / known.weights.sum())

        return loss

    @torch.no_grad()
    def _rollout(self, episode: Episode) -> RolloutBuffer:
        """The episode as Stable-Baselines3 has it, with advantages; as long as the episode is."""
        assert episode.last_observation is not None, 'the episode has not ended'
        observations, actions = np.array(episode.observations), np.array(episode.actions)
        values, log_probabilities, _ = self.policy.evaluate_actions(
            torch.as_tensor(observations), torch.as_tensor(actions))
        buffer = RolloutBuffer(len(episode), self._ppo.observation_space, self._ppo.action_space, device='cpu',
                               gamma=self._ppo.gamma, gae_lambda=self._ppo.gae_lambda)
        for step, reward in enumerate(episode.rewards):
            buffer.add(observations[step], actions[step], np.array([reward]), np.array([step == 0]),
                       values[step], log_probabilities[step])
        last_value = self.policy.predict_values(torch.as_tensor(episode.last_observation).unsqueeze(0))
        buffer.compute_returns_and_advantage(last_value, np.array([episode.failed]))
        return buffer

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: weights, Adam's moments and step counts, and the remembered corrections."""
        return self._weights() | self.corrections.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        weights, corrections = self._weights(), self.corrections.tensors()
        check_tensors(tensors, weights | corrections, corrections.keys())
        for name, own in weights.items():
            own.copy_(tensors[name])
        self.corrections = Corrections(*(tensors[name] for name in corrections))

    def _weights(self) -> dict[str, torch.Tensor]:
        """Copying into these changes the learner."""
        parameters = list(self.policy.named_parameters())
        return {f'policy.{name}': parameter.data for name, parameter in parameters} | adam_tensors(
            self.policy.optimizer, parameters)


def _means(layers: Sequence[tuple[torch.Tensor, torch.Tensor]], observations: torch.Tensor) -> torch.Tensor:
    """What a network of these weights and biases gives. For one observation its modules take twice as long."""
    *hidden, last = layers
    for weight, bias in hidden:
        observations = torch.tanh(linear(observations, weight, bias))
    return linear(observations, *last)


@contextmanager
def _numpy_seeded(seed: int) -> Iterator[None]:
    """NumPy's global random numbers, which Stable-Baselines3 draws, begin at ``seed``, and are as before afterwards."""
    before = np.random.get_state()  # noqa: NPY002 - the generator that Stable-Baselines3 uses
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002
