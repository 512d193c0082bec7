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

"""Senses that are late and noisy."""

from collections import deque
from dataclasses import replace

import numpy as np
from shared_control.plant import PlantState

POSITION_NOISE = 0.002
"""Standard deviation of each coordinate of the ball, m."""
VELOCITY_NOISE = 0.01
"""Standard deviation of each component of its velocity, m/s."""
JOINT_NOISE = 0.001
"""Standard deviation of each joint's position, rad: the tray's pitch, to which three add, is wrong by 2 mrad."""


class PoorSenses:
    """A :class:`shared_control.env.Senses` that sees late, and with white noise.

    Args:
        late: how late, in policy periods; until then it sees the beginning.
        noise: whether there is any.
    """

    def __init__(self, late: int, noise: bool):
        self._noise = noise
        self._seen: deque[PlantState] = deque(maxlen=late + 1)
        self._random = np.random.default_rng()

    def reset(self, seed: int | None) -> None:
        """See :class:`shared_control.env.Senses`."""
        self._seen.clear()
        self._random = np.random.default_rng(seed)

    def perceive(self, state: PlantState) -> PlantState:
        """See :class:`shared_control.env.Senses`."""
        self._seen.append(state)
        seen = self._seen[0]
        if not self._noise:
            return seen
        return replace(
            seen, q=seen.q + JOINT_NOISE * self._random.standard_normal(len(seen.q)),
            ball_position=self._blurred(seen.ball_position, POSITION_NOISE),
            ball_velocity=self._blurred(seen.ball_velocity, VELOCITY_NOISE))

    def _blurred(self, values: tuple[float, ...], deviation: float) -> tuple[float, ...]:
        return tuple((np.array(values) + deviation * self._random.standard_normal(len(values))).tolist())
