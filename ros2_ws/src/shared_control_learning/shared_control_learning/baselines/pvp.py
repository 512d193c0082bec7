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

"""Proxy value propagation."""

from typing import Any

import torch
from stable_baselines3 import TD3
from stable_baselines3.common.utils import polyak_update
from torch.nn.functional import mse_loss

from ..ppo import Spaces
from .off_policy import OffPolicyLearner
from .presets import PvpSettings


class Pvp(OffPolicyLearner):
    """Z. Peng, W. Mo, C. Duan, Q. Li and B. Zhou, NeurIPS 2023, upon Stable-Baselines3's TD3; without any reward.

    Where the person intervened, the value of what then counted is to be 1 and that of what the robot wanted -1; TD
    carries both to other states, with a reward of 0, and the policy does what is worth most. Half of every minibatch
    are interventions. As long as nobody has intervened, nothing is learned.
    """

    settings: PvpSettings
    _algorithm: '_Td3'

    def make(self, spaces: Spaces, arguments: dict[str, Any]) -> TD3:
        """See :class:`OffPolicyLearner`."""
        return _Td3(self, 'MlpPolicy', spaces, tau=self.settings.tau, **arguments)

    def explored(self, observations: torch.Tensor, noise: torch.Tensor) -> torch.Tensor:
        """See :class:`OffPolicyLearner`: the policy and a little noise."""
        return self._algorithm.policy._predict(observations) + self.settings.exploring_std * noise

    def optimized(self) -> list[tuple[str, torch.optim.Optimizer, list[tuple[str, torch.Tensor]]]]:
        """See :class:`OffPolicyLearner`."""
        actor, critic = self._algorithm.actor, self._algorithm.critic
        return [('actor', actor.optimizer, [*actor.named_parameters()]),
                ('critic', critic.optimizer, [*critic.named_parameters()])]


class _Td3(TD3):
    """TD3 whose critics learn proxy values instead of rewards; the rest as in Stable-Baselines3's ``TD3.train``."""

    def __init__(self, learner: Pvp, *args: Any, **kwargs: Any):
        self._replay = learner.replay
        super().__init__(*args, **kwargs)

    def train(self, gradient_steps: int, batch_size: int = 100) -> None:
        """So many gradient steps."""
        if not self._replay.memory['intervened'].any():
            return
        self.policy.set_training_mode(True)
        for step in range(gradient_steps):
            batch = self._replay.sample(batch_size)
            own_actions, intervened = self._replay.rows('own_actions'), self._replay.rows('intervened')
            with torch.no_grad():
                noise = (torch.randn_like(batch.actions) * self.target_policy_noise).clamp(
                    -self.target_noise_clip, self.target_noise_clip)
                following = (self.actor_target(batch.next_observations) + noise).clamp(-1.0, 1.0)
                values = torch.cat(self.critic_target(batch.next_observations, following), dim=1)
                wanted = (1.0 - batch.dones) * self.gamma * values.min(dim=1, keepdim=True).values
            done = self.critic(batch.observations, batch.actions)
            refused = self.critic(batch.observations, own_actions)
            loss = torch.stack([
                0.5 * mse_loss(value, wanted)
                + (intervened * ((value - 1.0) ** 2 + (other + 1.0) ** 2)).mean()
                for value, other in zip(done, refused, strict=True)]).sum()
            self.critic.optimizer.zero_grad()
            loss.backward()
            self.critic.optimizer.step()
            if step % self.policy_delay == 0:
                loss = -self.critic.q1_forward(batch.observations, self.actor(batch.observations)).mean()
                self.actor.optimizer.zero_grad()
                loss.backward()
                self.actor.optimizer.step()
                for network, target in ((self.critic, self.critic_target), (self.actor, self.actor_target)):
                    polyak_update(network.parameters(), target.parameters(), self.tau)
