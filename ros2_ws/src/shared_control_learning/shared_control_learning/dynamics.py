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

"""A model of what moments do to what a learner sees, from all transitions so far, whoever gave the moments.

The moments that counted are recorded, so nothing has to be known of a person's delay or dead band.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import torch
from shared_control.tasks.task import Task

from .episode import Episode
from .memory import Memory

ROUNDS = 8
"""Rounds of reweighting; the weights have settled by then."""
TUKEY = 4.685
"""Residuals beyond so many standard deviations count nothing: 95 % efficient with Gaussian ones (Tukey's biweight)."""
STILL = 0.1
"""Part of its highest rates below which a quantity is taken to be held (see :func:`fit_dynamics`)."""
HIGHEST = 0.98
"""Quantile of the rates that is taken for the highest: with a ball that lies at a wall most of the time, the mean or
the standard deviation would be that of its trembling."""
RIDGE = 1e-3
"""Towards 'nothing changes' and 'no reward'."""
SHARPNESS = 8.0
"""How much more a reward near the best counts than a poor one: exp of this, over the range of the rewards."""


class Transitions:
    """The steps of the last episodes as the model sees them; a row each, float32.

    A state is ``[o, o - o_before, u_before]``: the task's observation (without integrals, which need no model), its
    change within the last policy period, and the moment that counted then, in actions.

    Args:
        task: what is observed.
        episodes: so many are remembered.
    """

    def __init__(self, task: Task, episodes: int):
        self._task, self._episodes = task, episodes
        self.size = task.observation_size
        axes = len(task.axes)
        self._memory = Memory('transitions.', states=2 * self.size + axes, moments=axes, next=self.size, rewards=1,
                              episodes=1)

    def add(self, episode: Episode, number: int) -> None:
        """Remember an episode, number ``number`` (from 1)."""
        assert episode.last_observation is not None, 'the episode has not ended'
        seen = np.array([*episode.observations, episode.last_observation])[:, :self.size]
        moments = episode.applied_actions
        change = np.diff(seen, axis=0, prepend=seen[:1])
        before = np.concatenate([np.zeros_like(moments[:1]), moments[:-1]])
        self._memory.add(
            states=np.concatenate([seen[:-1], change[:-1], before], axis=1), moments=moments, next=seen[1:],
            rewards=np.array(episode.rewards)[:, np.newaxis], episodes=np.full((len(moments), 1), number))
        self._memory.keep_last(int((self.episodes > number - self._episodes).sum()))

    def __getattr__(self, name: str) -> np.ndarray:
        if name in self.__dict__.get('_memory', ()):
            return self._memory[name]
        raise AttributeError(name)

    @property
    def moving(self) -> np.ndarray:
        """How freely what the task wants to be nothing (its position errors) was changing, 0..1; (rows,).

        What a wall holds counts nothing: it moves as no ball on the plate does. All count alike when nothing moved.
        """
        rates = self.states[:, [self.size + error for error in self._task.errors]].astype(float)
        if not rates.any():
            return np.ones(len(rates))
        still = (STILL * np.quantile(np.abs(rates), HIGHEST, axis=0)) ** 2 + 1e-12
        return (rates ** 2 / (rates ** 2 + still)).prod(axis=1)

    def tensors(self) -> dict[str, torch.Tensor]:
        """By name, for a policy file."""
        return self._memory.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """Become those that gave these tensors, which :func:`.learner.check_tensors` has checked."""
        self._memory.restore(tensors)


@dataclass(frozen=True)
class Dynamics:
    """``s' = A s + B u + c`` over some policy periods with the moment held, and what a state is worth."""

    ab: torch.Tensor
    """[A B]^T, (2 n + 2 k, 2 n + k)"""
    c: torch.Tensor
    """(2 n + k,)"""
    curvature: torch.Tensor
    """Q of the reward ``o Q o + q o``, (n, n), negative semidefinite"""
    slope: torch.Tensor
    """q, (n,)"""

    def step(self, state: torch.Tensor, moment: torch.Tensor) -> torch.Tensor:
        """States, (rows, 2 n + k), after moments, (rows, k), in actions."""
        return torch.addmm(self.c, torch.cat([state, moment], dim=1), self.ab)

    def reward(self, seen: torch.Tensor) -> torch.Tensor:
        """Rewards, (...,), of observations, (..., n), up to a constant."""
        return ((seen @ self.curvature) * seen).sum(dim=-1) + seen @ self.slope

    @property
    def best_reward(self) -> float:
        """The most that :meth:`reward` can give along the directions that it curves in."""
        values, vectors = torch.linalg.eigh(self.curvature)
        along = self.slope @ vectors
        curved = values < 1e-3 * values.min()
        return float((along[curved] ** 2 / (-4.0 * values[curved])).sum())


def fit_dynamics(known: Transitions, periods: int) -> Dynamics:
    """The model of ``known`` transitions, a step of it as long as so many policy ``periods``.

    Least squares for each entry of the observation. A ball that a wall holds, or that bounces off it, moves as no ball
    on the plate does, and would bend the model, up to a wrong sign when somebody keeps it there most of the time. So a
    transition counts by how much the position errors were changing before (the entry itself, for a task that names
    none), so that what is held counts nothing; and Tukey's biweight, which begins at "nothing changes", leaves out
    what fits badly.
    """
    n = known.size
    states, moments = known.states.astype(float), known.moments.astype(float)
    inputs = np.concatenate([states, moments, np.ones((len(states), 1))], axis=1)
    changes = known.next - states[:, :n]
    width = states.shape[1]
    a, b, c = np.eye(width), np.zeros((width, moments.shape[1])), np.zeros(width)
    moving = known.moving
    for entry in range(n):
        solution = _robust(inputs, changes[:, entry], moving)
        a[entry] += solution[:width]
        a[n + entry] = solution[:width]
        b[entry] = b[n + entry] = solution[width:-1]
        c[entry] = c[n + entry] = solution[-1]
    a[2 * n:], b[2 * n:] = 0.0, np.eye(moments.shape[1])
    held_a, held_b, held_c = np.eye(width), np.zeros_like(b), np.zeros_like(c)
    for _ in range(periods):
        held_a, held_b, held_c = a @ held_a, a @ held_b + b, a @ held_c + c
    curvature, slope = _reward(known.next.astype(float), known.rewards[:, 0].astype(float))
    return Dynamics(*(torch.tensor(values, dtype=torch.float32) for values in (
        np.concatenate([held_a, held_b], axis=1).T, held_c, curvature, slope)))


def _robust(inputs: np.ndarray, wanted: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """Weighted ridge regression, reweighted by its own residuals; the first are those of "nothing changes"."""
    solution = np.zeros(inputs.shape[1])
    for _ in range(ROUNDS):
        residuals = np.abs(wanted - inputs @ solution)
        of_moving = residuals[moving > 0.5]
        deviation = 1.4826 * float(np.median(of_moving)) if len(of_moving) else float(residuals.std())
        weights = moving * np.clip(1.0 - (residuals / (TUKEY * deviation + 1e-6)) ** 2, 0.0, 1.0) ** 2
        weighted = inputs * weights[:, np.newaxis]
        solution = np.linalg.solve(weighted.T @ inputs + RIDGE * np.eye(inputs.shape[1]), weighted.T @ wanted)
    return solution


def _reward(seen: np.ndarray, rewards: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Q, negative semidefinite, and q of a quadratic reward; good states count more than poor ones."""
    n = seen.shape[1]
    rows, columns = np.triu_indices(n)
    inputs = np.concatenate([seen[:, rows] * seen[:, columns], seen, np.ones((len(seen), 1))], axis=1)
    low, high = np.quantile(rewards, (0.05, 0.95))
    weights = np.exp(np.clip(SHARPNESS * (rewards - rewards.max()) / (high - low + 1e-9), -SHARPNESS, 0.0))
    weighted = inputs * weights[:, np.newaxis]
    solution = np.linalg.solve(weighted.T @ inputs + RIDGE * np.eye(inputs.shape[1]), weighted.T @ rewards)
    curvature = np.zeros((n, n))
    curvature[rows, columns] = solution[:len(rows)]
    values, vectors = np.linalg.eigh((curvature + curvature.T) / 2.0)
    return vectors @ np.diag(np.minimum(values, 0.0)) @ vectors.T, solution[len(rows):-1]
