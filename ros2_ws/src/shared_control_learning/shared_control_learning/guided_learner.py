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

"""PPO that also learns what all moments did, whoever gave them."""

from collections.abc import Mapping

import torch
from shared_control.rates import POLICY_PERIOD
from shared_control.seeds import episode_seed
from shared_control.tasks.task import INTEGRAL_BOUND, OBSERVATION_BOUND, Task

from .dynamics import Dynamics, Transitions, fit_dynamics
from .episode import Episode
from .learner import check_tensors
from .ppo_learner import PpoLearner
from .settings import GuidedSettings


class GuidedLearner(PpoLearner):
    """A :class:`Learner`: PPO's update of an episode, then the policy is improved in a model of all transitions so far.

    The model (:mod:`.dynamics`) is made of what the moments that counted did, whether person, agent or both gave them.
    So a person who helps badly teaches it as well as one who helps, and nothing of their delay or dead band matters.
    In imagined episodes from states that were seen, each under a moment of its own that pushes for good, the policy's
    parameters follow the gradient through the model (L-BFGS on one batch; Deisenroth and Rasmussen, 2011, and Heess et
    al., 2015, improve policies through models). The objective is the mean logarithm of what the episodes lack of the
    best reward, so that those that cannot be saved do not count for more than all others.

    Args:
        name: of the settings.
        task: what it learns.
        settings: how.
        seed: of the first weights and of everything random after them.
    """

    settings: GuidedSettings

    def __init__(self, name: str, task: Task, settings: GuidedSettings, seed: int = 0):
        super().__init__(name, task, settings, seed)
        self._known = Transitions(task, settings.model.memory_episodes)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`."""
        number = self.episode + 1
        self._known.add(episode, number)
        dynamics = fit_dynamics(self._known, self.settings.model.periods)
        return {**super().learn_from(episode), **self._improve(dynamics, number)}

    def _imagine(self, dynamics: Dynamics, states: torch.Tensor, integrals: torch.Tensor, push: torch.Tensor,
                 ) -> tuple[torch.Tensor, torch.Tensor]:
        """Episodes of the policy alone in the model: rewards, (steps, rows), and actions, (steps, rows, k).

        Args:
            states: where they begin, (rows, 2 n + k).
            integrals: of the position errors then, (rows, m); m is 0 for a task that does not integrate.
            push: a moment that is there all the time, in actions, (rows, k).
        """
        size, errors = self._known.size, list(self.task.errors)
        seconds = self.settings.model.periods * POLICY_PERIOD
        visited, actions = [], []
        for _ in range(self.settings.model.steps):
            seen = states[:, :size]
            action = self.means(torch.cat([seen, integrals], dim=1)).clamp(-1.0, 1.0)
            states = dynamics.step(states, action + push)
            if self.task.integrates:
                integrals = (integrals + seconds * states[:, errors]).clamp(-INTEGRAL_BOUND, INTEGRAL_BOUND)
            visited.append(states)
            actions.append(action)
        seen = torch.stack(visited)[:, :, :size].clamp(-OBSERVATION_BOUND, OBSERVATION_BOUND)
        return dynamics.reward(seen), torch.stack(actions)

    def _improve(self, dynamics: Dynamics, number: int) -> dict[str, float]:
        """Improve the policy in the model, if it can be."""
        model = self.settings.model
        random = torch.Generator().manual_seed(episode_seed(self.seed, number) ^ 1)
        axes = len(self.task.axes)
        drawn = torch.multinomial(torch.as_tensor(self._known.moving), model.batch, replacement=True, generator=random)
        states = torch.as_tensor(self._known.states)[drawn]
        states[:, 2 * self._known.size:] = 2.0 * torch.rand(model.batch, axes, generator=random) - 1.0
        push = model.push * torch.randn(model.batch, axes, generator=random)
        integrals = torch.zeros(model.batch, self.task.observed_size - self._known.size)
        best = model.steps * dynamics.best_reward

        def objective() -> torch.Tensor:
            rewards, actions = self._imagine(dynamics, states, integrals, push)
            earned = rewards.sum(dim=0)
            restless = (actions.diff(dim=0) ** 2).sum(dim=(0, 2))
            return torch.log1p((best - earned + model.restlessness * restless).clamp(min=0.0)).mean()

        parameters = [*self.policy.action_net.parameters(), *self.policy.mlp_extractor.policy_net.parameters()]
        before = [parameter.detach().clone() for parameter in parameters]
        with torch.no_grad():
            was = float(objective())
        optimizer = torch.optim.LBFGS(
            parameters, max_iter=model.iterations, max_eval=model.iterations * 5 // 4, line_search_fn='strong_wolfe')

        def closure() -> torch.Tensor:
            optimizer.zero_grad()
            loss = objective()
            loss.backward()
            return loss

        optimizer.step(closure)
        with torch.no_grad():
            now = float(objective())
            if not now < was:  # nan as well
                for parameter, value in zip(parameters, before, strict=True):
                    parameter.copy_(value)
                now = was
        return {'model/lost_before': was, 'model/lost': now}

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: the transitions as well."""
        return super().tensors() | self._known.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        own = self._known.tensors()
        known = {name: tensor for name, tensor in tensors.items() if name in own}
        check_tensors(known, own, own.keys())
        super().restore({name: tensor for name, tensor in tensors.items() if name not in own})
        self._known.restore(known)
