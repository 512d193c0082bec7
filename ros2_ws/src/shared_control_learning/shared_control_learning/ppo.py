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

"""Stable-Baselines3's PPO with one more term in its loss, and a learning rate that falls within an update."""

from collections.abc import Callable

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.type_aliases import RolloutBufferSamples
from torch.nn.functional import mse_loss


class Spaces(gymnasium.Env[np.ndarray, np.ndarray]):
    """The spaces that PPO asks an environment for. The episodes come from elsewhere: it is never stepped."""

    def __init__(self, observation_space: gymnasium.spaces.Box, action_space: gymnasium.spaces.Box):
        self.observation_space = observation_space
        self.action_space = action_space


class ExtraLossPPO(PPO):
    """PPO that adds ``extra_loss()`` to the loss of every minibatch; without one it is Stable-Baselines3's."""

    extra_loss: Callable[[], torch.Tensor] | None = None
    rate_end: float = 1.0
    """What part of the learning rate is left after the last epoch; it falls linearly, epoch by epoch."""

    def train(self) -> None:
        """PPO's epochs over the rollout buffer."""
        if self.extra_loss is None and self.rate_end == 1.0:
            super().train()
            return
        self.policy.set_training_mode(True)
        for left in np.linspace(1.0, self.rate_end, self.n_epochs, endpoint=False):
            self._update_learning_rate(self.policy.optimizer)
            for group in self.policy.optimizer.param_groups:
                group['lr'] *= left
            for batch in self.rollout_buffer.get(self.batch_size):
                loss = self._loss(batch)
                if self.extra_loss is not None:
                    loss = loss + self.extra_loss()
                self.policy.optimizer.zero_grad()
                loss.backward()
                torch.nn.utils.clip_grad_norm_(self.policy.parameters(), self.max_grad_norm)
                self.policy.optimizer.step()
            self._n_updates += 1

    def _loss(self, batch: RolloutBufferSamples) -> torch.Tensor:
        """The clipped surrogate, value and entropy loss of a minibatch, as in Stable-Baselines3's ``PPO.train``."""
        values, log_probability, entropy = self.policy.evaluate_actions(batch.observations, batch.actions)
        advantages = batch.advantages
        if len(advantages) > 1:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        ratio = torch.exp(log_probability - batch.old_log_prob)
        assert entropy is not None, 'a Gaussian policy has an entropy'
        clip = self.clip_range(1.0)  # type: ignore[operator]
        surrogate = torch.min(advantages * ratio, advantages * ratio.clamp(1 - clip, 1 + clip)).mean()
        return (-surrogate - self.ent_coef * entropy.mean()
                + self.vf_coef * mse_loss(batch.returns, values.flatten()))
