"""PPO that also learns what all moments did, and believes a correction when that was better than going on alone."""

from collections.abc import Mapping
from dataclasses import fields

import numpy as np
import torch
from shared_control.rates import POLICY_PERIOD
from shared_control.seeds import episode_seed
from shared_control.tasks.task import INTEGRAL_BOUND, OBSERVATION_BOUND, Task

from .corrections import Corrections, find_corrections
from .dynamics import Dynamics, Transitions, fit_dynamics
from .episode import Episode
from .ppo_learner import PpoLearner
from .settings import GuidedSettings

_TRANSITIONS = 'transitions.'


class GuidedLearner(PpoLearner):
    """A :class:`Learner`: PPO's update of an episode, then the policy is improved in a model of all transitions so far.

    The model (:mod:`.dynamics`) is made of what the moments that counted did, whether person, agent or both gave them.
    So a person who helps badly teaches it as well as one who helps, and nothing of their delay or dead band matters.
    In imagined episodes from states that were seen, each under a moment of its own that pushes for good, the policy's
    parameters follow the gradient through the model (L-BFGS on one batch; Deisenroth and Rasmussen, 2011, and Heess et
    al., 2015, improve policies through models). The objective is the mean logarithm of what the episodes lack of the
    best reward, so that those that cannot be saved do not count for more than all others.

    A person's corrections are labels, as in :class:`PpoLearner`, if they were worth it: what followed the state, with
    the person, earned more than the policy alone would have, in the model (a Q-filter, Nair et al., 2018).

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
        offered = self._judge(episode, number, dynamics)
        figures = super().learn_from(episode)
        return {**figures, **self._improve(dynamics, number), 'train/corrections_offered': float(offered),
                'train/corrections': float(len(self.corrections))}

    def _coaching_loss(self, episode: Episode) -> None:
        """PPO's own update is PPO's alone."""

    def _judge(self, episode: Episode, number: int, dynamics: Dynamics) -> int:
        """Remember the corrections that were worth it; gives how many there were."""
        coaching = self.settings.coaching
        if coaching is None:
            return 0
        with torch.no_grad():
            means = self.means(torch.as_tensor(np.array(episode.observations))).clamp(-1.0, 1.0).numpy()
            found, steps = find_corrections(episode, number, means, coaching)
            worth = self._worth(episode, number, dynamics)[steps]
        believed = Corrections(*(getattr(found, f.name)[worth] for f in fields(found)))
        self.corrections = self.corrections.since(number - coaching.memory_episodes + 1).followed_by(believed)
        return len(found)

    def _worth(self, episode: Episode, number: int, dynamics: Dynamics) -> torch.Tensor:
        """Whether what followed each step of the episode earned more than the policy alone would have, (steps,)."""
        model, size = self.settings.model, self._known.size
        seen = torch.as_tensor(np.array([*episode.observations, episode.last_observation]))
        states = torch.as_tensor(self._known.states[self._known.episodes[:, 0] == number])
        earned = dynamics.reward(seen[:, :size])
        ahead = model.periods * torch.arange(1, model.foresight + 1)
        later = torch.arange(len(episode))[:, None] + ahead
        real = earned[later.clamp(max=len(episode))].sum(dim=1)
        push = torch.zeros(len(episode), len(self.task.axes))
        rewards, _ = self._imagine(dynamics, states, seen[:-1, size:], push, model.foresight)
        alone = rewards.sum(dim=0)
        return (real > alone) & (later[:, -1] <= len(episode))

    def _imagine(self, dynamics: Dynamics, states: torch.Tensor, integrals: torch.Tensor, push: torch.Tensor,
                 steps: int) -> tuple[torch.Tensor, torch.Tensor]:
        """Episodes of the policy alone in the model: rewards, (steps, rows), and actions, (steps, rows, k).

        Args:
            states: where they begin, (rows, 2 n + k).
            integrals: of the position errors then, (rows, m); m is 0 for a task that does not integrate.
            push: a moment that is there all the time, in actions, (rows, k).
        """
        size, errors = self._known.size, list(self.task.errors)
        seconds = self.settings.model.periods * POLICY_PERIOD
        visited, actions = [], []
        for _ in range(steps):
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
        model, coaching = self.settings.model, self.settings.coaching
        random = torch.Generator().manual_seed(episode_seed(self.seed, number) ^ 1)
        axes = len(self.task.axes)
        drawn = torch.randint(len(self._known.states), (model.batch,), generator=random)
        states = torch.as_tensor(self._known.states)[drawn]
        states[:, 2 * self._known.size:] = 2.0 * torch.rand(model.batch, axes, generator=random) - 1.0
        push = model.push * torch.randn(model.batch, axes, generator=random)
        integrals = torch.zeros(model.batch, self.task.observed_size - self._known.size)
        best = model.steps * dynamics.best_reward
        advice = 0.0 if coaching is None or not len(self.corrections) else model.advice * coaching.weight_in(number)

        def objective() -> torch.Tensor:
            rewards, actions = self._imagine(dynamics, states, integrals, push, model.steps)
            earned = rewards.sum(dim=0)
            restless = (actions.diff(dim=0) ** 2).sum(dim=(0, 2))
            lost = torch.log1p((best - earned + model.restlessness * restless).clamp(min=0.0)).mean()
            return lost if advice == 0.0 else lost + advice * self._advice_loss()

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

    def _advice_loss(self) -> torch.Tensor:
        known = self.corrections
        squares = ((self.means(known.observations) - known.labels) ** 2).sum(dim=1, keepdim=True)
        return (known.weights * squares).sum() / known.weights.sum()

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: the transitions as well."""
        return super().tensors() | self._known.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        own = self._known.tensors().keys()
        if not own <= tensors.keys():
            raise ValueError(f'it should hold the tensors {", ".join(sorted(own - tensors.keys()))}')
        super().restore({name: tensor for name, tensor in tensors.items() if name not in own})
        self._known.restore(tensors)
