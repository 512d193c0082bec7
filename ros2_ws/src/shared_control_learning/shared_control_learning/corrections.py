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

"""What the person's key presses say about the policy."""

from dataclasses import dataclass, fields

import numpy as np
import torch
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.task import Task

from .episode import Episode
from .learner import ROWS_MAX
from .settings import CoachingSettings


@dataclass(frozen=True, eq=False)
class Corrections:
    """Corrected states, and what the policy should have done there; a row each."""

    observations: torch.Tensor
    """(rows, n), float32"""
    labels: torch.Tensor
    """(rows, k), float32"""
    weights: torch.Tensor
    """(rows, 1), float32: the part of the delays with which the person held a moment."""
    episodes: torch.Tensor
    """(rows, 1), float32: in which episode, from 1."""

    @classmethod
    def none(cls, task: Task) -> 'Corrections':
        """Not one."""
        return cls(*(torch.zeros(0, columns) for columns in (task.observed_size, len(task.axes), 1, 1)))

    def tensors(self) -> dict[str, torch.Tensor]:
        """By name, for a policy file."""
        return {f'corrections.{f.name}': getattr(self, f.name) for f in fields(self)}

    def __len__(self) -> int:
        return len(self.labels)

    def followed_by(self, later: 'Corrections') -> 'Corrections':
        """These and ``later`` ones; the last :data:`~.learner.ROWS_MAX`, since no more are read from a file."""
        return Corrections(*(
            torch.cat([getattr(self, f.name), getattr(later, f.name)])[-ROWS_MAX:] for f in fields(self)))

    def since(self, episode: int) -> 'Corrections':
        """Those of ``episode`` and later ones."""
        kept = self.episodes[:, 0] >= episode
        return Corrections(*(getattr(self, f.name)[kept] for f in fields(self)))


def find_corrections(episode: Episode, number: int, means: np.ndarray, coaching: CoachingSettings,
                     ) -> Corrections:
    """The corrections of an episode.

    People react late, and some later than others: the moment held at t corrects what the policy did at t - d, for
    all d in D alike. The label is the mean of ``clip(pi(s_{t-d}) + g M_h(t) / M_max)`` over D, and it weighs as
    much as the part of D with a moment held.

    Args:
        number: of the episode, from 1.
        means: what the policy does in the states of the episode without exploring, (steps, k).
    """
    steps = len(episode)
    later = [min(round(delay / POLICY_PERIOD), steps) for delay in coaching.delays]
    held = np.array(episode.human, np.float32)
    human = np.stack([np.append(held[d:], np.zeros_like(held[:d]), axis=0) for d in later], axis=1)  # (steps, D, k)
    human[steps - max(later):] = 0.0  # what people would have pressed after the end is not known
    scale = episode.task.scale.astype(np.float32)
    labels = np.clip(means[:, np.newaxis] + coaching.gain * human / scale, -1.0, 1.0).mean(axis=1)
    weights = (human != 0.0).any(axis=2).mean(axis=1, keepdims=True)
    corrected = np.flatnonzero(weights)
    return Corrections(*(torch.as_tensor(values[corrected].astype(np.float32)) for values in (
        np.array(episode.observations), labels, weights, np.full((steps, 1), number))))
