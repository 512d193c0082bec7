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

"""Identify, then regulate: a classical answer to the same episodes."""

from collections.abc import Mapping

import numpy as np
import torch
from scipy.linalg import solve_discrete_lyapunov
from scipy.optimize import minimize
from shared_control.tasks.task import Task

from ..dynamics import Dynamics, Transitions, fit_dynamics
from ..episode import Episode
from ..learner import check_tensors
from ..noise import CorrelatedNoise
from .linear import LinearLearner
from .lqr import regulator
from .needs import check_errors
from .presets import IdentifiedLqrSettings


class IdentifiedLqr(LinearLearner):
    """The LQR of the linear model that fits the transitions so far, whoever gave the moments.

    The model is :func:`shared_control_learning.dynamics.fit_dynamics`'s, of ``[o, o - o_before, u_before]``: plain
    least squares fail on ``balance``, where the ball lies at a wall for half of an exciting episode. A policy knows o
    alone, so the gain on o is the one with the least cost in the model (output feedback: W. Levine and M. Athans, IEEE
    Trans. Automatic Control 15, 1970), sought from that of the LQR (L. Ljung, System Identification, 1999, for
    the rest of the recipe). The first episode excites the arm by a random moment; later ones by half as much each.

    Raises:
        ValueError: the task names no position errors, which are to become zero.
    """

    settings: IdentifiedLqrSettings

    def __init__(self, name: str, task: Task, settings: IdentifiedLqrSettings, seed: int = 0):
        super().__init__(name, task, settings, seed)
        check_errors(name, task)
        self._known = Transitions(task, settings.memory_episodes)
        self._noise = CorrelatedNoise(len(task.axes), settings.excitation_seconds)

    def begin(self) -> int:
        """See :class:`Learner`."""
        seed = super().begin()
        self._noise.begin(seed)
        return seed

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See :class:`Learner`: an exciting moment is added."""
        std = self.settings.excitation * self.settings.excitation_decay ** self.episode
        return (self.act(observation) + std * self._noise.next().numpy()).astype(np.float32)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See :class:`Learner`. What no gain stabilises leaves the policy as it is."""
        self._known.add(episode, self.episode + 1)
        found = self._regulate(fit_dynamics(self._known, 1))
        if found is not None:
            self.weights, self.bias = found
        return {**super().learn_from(episode), 'model/stabilised': float(found is not None)}

    def _regulate(self, model: Dynamics) -> tuple[np.ndarray, np.ndarray] | None:
        """Weights and bias that bring the position errors to zero in the model; None when none do."""
        n, k, errors = self.task.observed_size, len(self.task.axes), list(self.task.errors)
        ab, c = model.ab.numpy().T.astype(float), model.c.numpy().astype(float)
        a, b = ab[:, :-k], ab[:, -k:]
        wanted = np.eye(len(a))[errors]
        # At rest x = a x + b u + c, with no position error.
        still = np.block([[a - np.eye(len(a)), b], [wanted, np.zeros((len(errors), k))]])
        rest = np.linalg.lstsq(still, np.concatenate([-c, np.zeros(len(errors))]), rcond=None)[0]
        weights = wanted.T @ wanted * self.settings.error ** -2
        costs = np.eye(k) * self.settings.moment ** -2
        seen = np.eye(len(a))[:n]
        try:
            first = regulator(a, b, weights, costs)[:, :n]
        except np.linalg.LinAlgError:
            return None

        def cost(gain: np.ndarray) -> float:
            """Expected cost from errors, velocities and tilts of one unit each; how unstable it is, if it is."""
            fed_back = gain.reshape(k, n) @ seen
            closed = a - b @ fed_back
            radius = np.abs(np.linalg.eigvals(closed)).max()
            if not radius < 1.0 - 1e-6:
                return 1e12 * float(radius)
            value = solve_discrete_lyapunov(closed.T, weights + fed_back.T @ costs @ fed_back)
            return float(np.trace(seen @ value @ seen.T))

        best = minimize(cost, first.ravel(), method='Nelder-Mead', options={'maxiter': 200 * k * n})
        if not best.fun < 1e12:
            return None
        gain = best.x.reshape(k, n)
        return -gain, gain @ rest[:n] + rest[len(a):]

    def tensors(self) -> dict[str, torch.Tensor]:
        """See :class:`Learner`: the transitions as well."""
        return super().tensors() | self._known.tensors()

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See :class:`Learner`."""
        check_tensors(tensors, self.tensors(), self._known.tensors().keys())
        super().restore({name: tensors[name] for name in ('weights', 'bias')})
        self._known.restore(tensors)
