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

"""One episode, taught or tested: what happened in it, step by step, and its figures."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.task import Task, settled
from shared_control.verdict import Verdict


@dataclass(eq=False)
class Episode:
    """The steps of an episode; what agent and human gave and what was applied are kept apart.

    ``k`` is the number of the task's axes.
    """

    task: Task
    number: int = 1
    """From 1."""
    phase: str = 'teach'
    """``teach`` or ``test``"""
    observations: list[np.ndarray] = field(default_factory=list)
    """What was seen at each step, (n,), float32"""
    actions: list[np.ndarray] = field(default_factory=list)
    """As the learner drew them, not clipped; of each step, (k,), float32"""
    rewards: list[float] = field(default_factory=list)
    """As the learner sees them, scaled."""
    human: list[np.ndarray] = field(default_factory=list)
    """The human's moment of each step, (k,), N m"""
    agent: list[np.ndarray] = field(default_factory=list)
    """The agent's moment of each step, (k,), N m"""
    applied: list[np.ndarray] = field(default_factory=list)
    """The moment applied in each step, (k,), N m"""
    position_error: list[float] = field(default_factory=list)
    """Position error of each step, m (see ``TaskState``)"""
    velocity: list[float] = field(default_factory=list)
    """Velocity of each step, m/s (see ``TaskState``)"""
    on_tray: list[tuple[float, float]] = field(default_factory=list)
    """Where the ball was after each step, in the tray's frame, m; empty when the task does not give it."""
    reward_terms: dict[str, float] = field(default_factory=dict)
    """Sums by name, unscaled."""
    failed: bool = False
    """It ended because the task failed (the ball fell); False when time was up."""
    last_observation: np.ndarray | None = None
    """What was seen after the last step."""
    learn_seconds: float = 0.0
    """Duration of the update after the episode, s."""
    verdict: Verdict = Verdict.NONE
    """What a person has said of it."""
    reason: str = ''
    """Why it was broken off; empty: it was not."""

    def __post_init__(self) -> None:
        self.reward_terms = self.reward_terms or dict.fromkeys(self.task.reward_names, 0.0)

    def __len__(self) -> int:
        return len(self.rewards)

    def add(self, observation: np.ndarray, action: np.ndarray, reward: float, info: dict[str, Any]) -> None:
        """One step: what was seen and done, and what ``SharedControlEnv.step`` gave for it."""
        self.observations.append(observation)
        self.actions.append(action)
        self.rewards.append(reward)
        self.human.append(info['human'])
        self.agent.append(info['agent'])
        self.applied.append(info['applied'])
        self.position_error.append(info['state'].position_error)
        self.velocity.append(info['state'].velocity)
        if (on_tray := info.get('on_tray')) is not None:
            self.on_tray.append(on_tray)
        for name, value in info['reward_terms'].items():
            self.reward_terms[name] += value
        self.failed = info['failed']

    @property
    def success(self) -> bool:
        """Whether the task was done, as the task judges an episode."""
        return self.task.succeeded(np.array(self.position_error), np.array(self.velocity), self.failed)

    @property
    def episode_return(self) -> float:
        """Sum of the reward, unscaled and not discounted."""
        return sum(self.reward_terms.values())

    @property
    def human_share(self) -> float:
        """Mean of |M_h| / (|M_h| + |M_a|), 0..1."""
        human, agent = _magnitudes(self.human), _magnitudes(self.agent)
        both = human + agent
        return float(np.divide(human, both, out=np.zeros_like(both), where=both > 0.0).mean()) if len(self) else 0.0

    @property
    def applied_actions(self) -> np.ndarray:
        """The moments that counted, whoever gave them, in actions, (steps, k); may lie beyond -1..1."""
        return np.array(self.applied) / self.task.scale

    @property
    def held(self) -> np.ndarray:
        """In which steps the human held a moment, (steps,), bool."""
        return _magnitudes(self.human) != 0.0

    @property
    def intervention_rate(self) -> float:
        """Part of the steps in which the human held a moment, 0..1."""
        return float(self.held.mean()) if len(self) else 0.0

    @property
    def interventions(self) -> int:
        """How often the human began to hold a moment."""
        held = self.held
        return int((held & ~np.append(False, held[:-1])).sum())

    @property
    def presses(self) -> int:
        """How often the human's moment changed, once a step at most: key presses, where there are keys."""
        moments = np.array(self.human)
        return int((np.diff(moments, axis=0, prepend=np.zeros_like(moments[:1])) != 0.0).any(axis=1).sum())

    def noise_share(self, act: Callable[[np.ndarray], np.ndarray]) -> float:
        """What part of the moments that counted is exploring, 0..1: mean squares, of noise, policy and human.

        Args:
            act: the policy that explored, observation (n,) -> action (k,), as it does without.
        """
        scale = self.task.scale
        tried = np.array(self.actions).clip(-1.0, 1.0) * scale
        own = np.array([act(seen) for seen in self.observations]) * scale
        counted = np.divide(np.array(self.agent), tried, out=np.zeros_like(tried), where=tried != 0.0)
        noise, policy, human = (float((moments ** 2).sum()) for moments in (
            counted * (tried - own), counted * own, np.array(self.human)))
        return noise / (noise + policy + human) if noise else 0.0

    def row(self) -> dict[str, float | int | str]:
        """The figures by name, for a table. Moments of several axes count by their magnitude."""
        human, agent = _signed(self.human), _signed(self.agent)
        return {
            'episode': self.number, 'phase': self.phase, 'steps': len(self),
            'seconds': round(len(self) * POLICY_PERIOD, 3), 'return': self.episode_return, **self.reward_terms,
            'fallen': int(self.failed), 'mean_abs_human': float(np.abs(human).mean()),
            'mean_abs_agent': float(np.abs(agent).mean()),
            'std_human': float(np.std(human)), 'std_agent': float(np.std(agent)),
            'human_share': self.human_share,
            'intervention_rate': self.intervention_rate,
            'settled_position_error': settled(np.array(self.position_error)),
            'settled_velocity': settled(np.array(self.velocity)), 'learn_seconds': self.learn_seconds,
            'verdict': str(self.verdict), 'reason': self.reason}


def _magnitudes(moments: list[np.ndarray]) -> np.ndarray:
    return np.abs(_signed(moments))


def _signed(moments: list[np.ndarray]) -> np.ndarray:
    """(steps,), N m: of one axis as it is, of several its magnitude."""
    stacked = np.array(moments)
    return stacked[:, 0] if stacked.shape[1:] == (1,) else np.linalg.norm(stacked, axis=-1)
