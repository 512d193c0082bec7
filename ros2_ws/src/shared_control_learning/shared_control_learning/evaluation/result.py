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

"""What a test of a policy measured."""

from dataclasses import dataclass

import numpy as np

TRANSFER = 'transfer: '
"""How the names of tests on other arms begin."""
CHECKPOINT = 'after episode '
"""How the names of randomised tests of policies on the way begin."""
TRACKS = ('position_error', 'velocity', 'velocity_error', 'agent_moment', 'manipulability')
"""The arrays over time that a :class:`ProtocolResult` holds, by name."""


@dataclass(frozen=True, eq=False)
class ProtocolResult:
    """Tracks of all episodes of one test of one policy, at 50 Hz: one row an episode.

    After the ball has fallen a row is nan.
    """

    test: str
    """``randomized``, ``perturbation``, or ``trajectory 0.25 Hz``, ``transfer: ball of 0.6 kg`` and so on."""
    seconds: np.ndarray
    """Time in the episode, (steps,), s: the end of each policy period."""
    position_error: np.ndarray
    """Tray centre minus ball along base x, (episodes, steps), m. This and the next three are magnitudes for a task
    with two axes: distance from the goal, speeds, moment."""
    velocity: np.ndarray
    """Velocity of the ball along base x, (episodes, steps), m/s: what the policy sees."""
    velocity_error: np.ndarray
    """Tray minus ball along base x, (episodes, steps), m/s: the rate of the position error."""
    agent_moment: np.ndarray
    """M_yai over the period that ended then, (episodes, steps), N m"""
    manipulability: np.ndarray
    """k_w (34), (episodes, steps); the thesis quotes 1 - k_w^2."""
    fallen: np.ndarray
    """(episodes,), bool"""
    success: np.ndarray
    """As the task judges each episode, (episodes,), bool"""


def checkpoint(episode: int) -> str:
    """The name of the randomised test of a policy after so many episodes."""
    return f'{CHECKPOINT}{episode}'
