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

"""SAC with a buffer of interventions."""

from typing import Any

import torch
from stable_baselines3 import SAC

from ..ppo import Spaces
from .off_policy import OffPolicyLearner
from .presets import SacSettings


class SacInterventions(OffPolicyLearner):
    """Stable-Baselines3's SAC on all steps, half of every minibatch interventions.

    As HIL-SERL (J. Luo et al., Precise and Dexterous Robotic Manipulation via Human-in-the-Loop Reinforcement Learning,
    2024) does upon RLPD (P. Ball et al., Efficient Online Reinforcement Learning with Offline Data, ICML 2023), from
    what both learn: off-policy, from a reward, with symmetric sampling. Unlike RLPD it has two critics without layer
    normalisation, as Stable-Baselines3's have. Exploring is correlated, as O. Eberhard et al. (2023) do with SAC.
    """

    settings: SacSettings
    _algorithm: SAC

    def make(self, spaces: Spaces, arguments: dict[str, Any]) -> SAC:
        """See :class:`OffPolicyLearner`."""
        return SAC('MlpPolicy', spaces, tau=self.settings.tau, ent_coef=f'auto_{self.settings.initial_entropy_weight}',
                   **arguments)

    def explored(self, observations: torch.Tensor, noise: torch.Tensor) -> torch.Tensor:
        """See :class:`OffPolicyLearner`: a draw from the policy."""
        mean, log_std, _ = self._algorithm.actor.get_action_dist_params(observations)
        return torch.tanh(mean + log_std.exp() * noise)

    def optimized(self) -> list[tuple[str, torch.optim.Optimizer, list[tuple[str, torch.Tensor]]]]:
        """See :class:`OffPolicyLearner`."""
        algorithm = self._algorithm
        assert algorithm.ent_coef_optimizer is not None, 'it is learned'
        return [('actor', algorithm.actor.optimizer, [*algorithm.actor.named_parameters()]),
                ('critic', algorithm.critic.optimizer, [*algorithm.critic.named_parameters()]),
                ('entropy', algorithm.ent_coef_optimizer, [('log_weight', self._log_entropy_weight)])]

    @property
    def _log_entropy_weight(self) -> torch.Tensor:
        weight = self._algorithm.log_ent_coef
        assert weight is not None, 'it is learned'
        return weight

    def _own(self) -> dict[str, torch.Tensor]:
        return super()._own() | {'entropy.log_weight': self._log_entropy_weight.data}
