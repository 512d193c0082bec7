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

"""Learning to do what the person does: behaviour cloning, and HG-DAgger."""

from collections.abc import Mapping

import numpy as np
import torch
from shared_control.tasks.task import Task

from ..episode import Episode
from ..learner import check_tensors
from ..memory import Memory
from .linear import LinearLearner
from .presets import CloningSettings


class BehaviourCloning(LinearLearner):
    """Least squares of what the person did on what was to see (D. Pomerleau, ALVINN, NeurIPS 1988).

    While it is taught, the robot gives no moment: the person does the task alone, and shows so how it is done. The
    policy is linear, as those of ``coached`` and ``guided`` are, and fitted anew after every episode by ridge
    regression. The steps that it is fitted to are the last that showed something (:class:`.memory.Memory`).
    """

    settings: CloningSettings

    def __init__(self, name: str, task: Task, settings: CloningSettings, seed: int = 0):
        super().__init__(name, task, settings, seed)
        self._shown = Memory(observations=task.observed_size, actions=len(task.axes))

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`: nothing, the person shows."""
        return np.zeros(len(self.task.axes), np.float32)

    def shows(self, episode: Episode) -> np.ndarray:
        """Which steps show what to do, (steps,), bool."""
        return np.full(len(episode), True)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`. The action shown is the moment that counted: what the person wanted in all."""
        shown = self.shows(episode)
        self._shown.add(observations=np.array(episode.observations)[shown],
                        actions=episode.applied_actions.clip(-1.0, 1.0)[shown])
        if len(self._shown):
            seen = np.hstack([self._shown['observations'], np.ones((len(self._shown), 1))]).astype(float)
            solution = np.linalg.solve(seen.T @ seen + self.settings.ridge * np.eye(seen.shape[1]),
                                       seen.T @ self._shown['actions'])
            self.weights, self.bias = solution[:-1].T.copy(), solution[-1].copy()
        return {**super().learn_from(episode), 'train/shown': float(len(self._shown))}

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: what was shown as well."""
        return super().tensors() | self._shown.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        check_tensors(tensors, self.tensors(), self._shown.tensors().keys())
        super().restore({name: tensors[name] for name in LinearLearner.tensors(self)})
        self._shown.restore(tensors)


class HgDagger(BehaviourCloning):
    """Human-gated DAgger: M. Kelly, C. Sidrane, K. Driggs-Campbell and M. Kochenderfer, ICRA 2019.

    The first episode is shown as in behaviour cloning. From then on the robot acts, the person takes over when they
    think it necessary, and what they do meanwhile is added to what was shown; the policy is fitted to all of it.
    Without the paper's estimate of risk, which is for knowing where the policy may be trusted, not for learning.
    """

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`: its policy, once there is one."""
        return self.act(observation)

    def shows(self, episode: Episode) -> np.ndarray:
        """See :class:`BehaviourCloning`."""
        if self.episode == 0:
            return super().shows(episode)
        return episode.held
