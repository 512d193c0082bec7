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

"""Figures of episodes, and means with their standard error."""

from collections.abc import Sequence

import numpy as np
from shared_control.tasks.task import settled

from .result import ProtocolResult

FIGURES = {
    'kept': 'the ball was kept',
    'success': 'kept, and over the last 3 s at rest in the centre',
    'position_error': 'mean |position error|, m',
    'position_error_max': 'largest |position error|, m',
    'position_error_settled': 'mean |position error| over the last 3 s, m',
    'velocity_error': 'mean |velocity error|, m/s',
    'velocity_error_settled': 'mean |velocity error| over the last 3 s, m/s',
    'agent_moment': 'mean |M_yai|, N m',
    'k_w': 'mean manipulability (34)',
    'one_minus_k_w_squared': "mean of the appendix' form of it",
}
"""What :func:`episode_figures` gives, by name."""


def episode_figures(result: ProtocolResult) -> list[dict[str, float]]:
    """The figures of each episode, by the names of :data:`FIGURES`; of the time before the ball fell."""
    figures = []
    for row, errors in enumerate(result.position_error):
        steps = slice(int(np.isfinite(errors).sum()))
        error, velocity_error = errors[steps], result.velocity_error[row, steps]
        k_w = result.manipulability[row, steps]
        figures.append({
            'kept': float(not result.fallen[row]), 'success': float(result.success[row]),
            'position_error': float(np.abs(error).mean()),
            'position_error_max': float(np.abs(error).max()),
            'position_error_settled': settled(error),
            'velocity_error': float(np.abs(velocity_error).mean()),
            'velocity_error_settled': settled(velocity_error),
            'agent_moment': float(np.abs(result.agent_moment[row, steps]).mean()),
            'k_w': float(k_w.mean()), 'one_minus_k_w_squared': float((1 - k_w ** 2).mean())})
    return figures


def policy_figures(result: ProtocolResult) -> dict[str, float]:
    """The figures of a policy: means over its episodes."""
    episodes = episode_figures(result)
    return {name: float(np.mean([episode[name] for episode in episodes])) for name in FIGURES}


def mean_and_sem(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard error of the mean over the first axis, without nan; nan where too few are left."""
    known = np.isfinite(samples)
    count = known.sum(axis=0)
    with np.errstate(invalid='ignore', divide='ignore'):
        mean = np.where(known, samples, 0.0).sum(axis=0) / count
        squares = np.where(known, (samples - mean) ** 2, 0.0).sum(axis=0)
        return mean, np.sqrt(squares / (count - 1) / count)


def curve(results: Sequence[ProtocolResult], track: str, absolute: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Mean and SEM of a track over time, each (steps,).

    Over the policies when there are several, each standing for the mean of its episodes (as episodes of one policy are
    no independent samples of a condition); over the episodes of the one policy otherwise. Episodes count until the ball
    falls.

    Args:
        results: of the same test, one a policy.
        track: one of :data:`shared_control_learning.evaluation.result.TRACKS`.
        absolute: of the magnitude.
    """
    tracks = [np.abs(getattr(result, track)) if absolute else getattr(result, track) for result in results]
    return mean_and_sem(tracks[0] if len(tracks) == 1 else np.array([mean_and_sem(rows)[0] for rows in tracks]))
