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

"""The way round: a bar lies between the ball and its goal, and the reward is nearest where there is no way."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...scene import Box, Scene
from ..plate.scene import SIDE, THICKNESS, plate_scene
from ..plate.task import Plate

BAR_END = 0.05
"""x of the bar's free end in the tray's frame, m; the other is at the wall at -x. What is left is the gap."""
BAR_THICKNESS = 0.01
"""m"""
BAR_HEIGHT = 0.02
"""Above the surface, m: over the ball's centre, so that it cannot be rolled over."""
GOAL = (-0.06, 0.08)
"""Tray's frame, m."""

_LENGTH = BAR_END + SIDE / 2
DETOUR_SCENE = plate_scene(goal=GOAL, goal_radius=0.03, obstacles=(Box(
    (BAR_END - _LENGTH / 2, 0.0, THICKNESS + BAR_HEIGHT / 2), (_LENGTH, BAR_THICKNESS, BAR_HEIGHT), True),))


@dataclass(frozen=True)
class Detour(Plate):
    """Bring the ball round the bar to the goal behind it, and keep it there.

    The reward is that of ``plate`` with the straight distance to the goal: the way round costs at first.
    """

    name: ClassVar[str] = 'detour'
    errors: ClassVar[tuple[int, ...]] = ()  # the middle of the plate is not where the ball should be
    instruction: ClassVar[str] = 'Bring the ball round the bar to the goal and keep it there.'
    preset: ClassVar[str] = 'coached_network'
    scene: ClassVar[Scene] = DETOUR_SCENE
    start: ClassVar[tuple[tuple[float, float], tuple[float, float]]] = ((-0.12, 0.0), (-0.12, -0.05))
    test_seconds: ClassVar[float] = 15.0

    def aim(self, ball: np.ndarray) -> np.ndarray:
        """See :class:`Task`: along the bar to the gap, through it, and to the goal."""
        x, y = ball
        if y > 0.03:
            return np.array(GOAL)
        return np.array([0.1, 0.08]) if x > BAR_END + 0.025 else np.array([0.11, -0.07])
