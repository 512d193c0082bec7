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

"""Tray and ball, from the side: base +x is on the left, because the left key is to move the ball there.

With two axes from above (:mod:`teleop_key_node.from_above`).
"""

import math

import numpy as np
from shared_control_ros.watching.scene import Scene

from . import from_above
from .canvas import to_lines

STEEPER = 3
"""How many times steeper the tilt is drawn."""

_MAX_COLUMNS, _MAX_ROWS = 160, 40


def draw(scene: Scene, width: int, height: int, unicode: bool) -> list[str]:
    """The picture in ``height`` lines of ``width`` characters, centred."""
    if scene.from_above:
        return from_above.draw(scene, width, height, unicode)
    columns, rows = min(width, _MAX_COLUMNS), min(height, _MAX_ROWS)
    above = (height - rows) // 2
    lines = [''] * rows if scene.pitch is None else to_lines(_dots(scene, scene.pitch, 2 * columns, 4 * rows), unicode)
    return [''] * above + [line.center(width) for line in lines] + [''] * (height - rows - above)


def _dots(scene: Scene, pitch: float, width: int, height: int) -> np.ndarray:
    """The dots that are set, (height, width). Lengths are in dots, as wide as they are high in most fonts."""
    tray = scene.tray
    scale = 0.44 * width / tray.half_length
    half, radius = tray.half_length * scale, tray.ball.radius * scale
    middle_x, middle_y = width / 2 - 0.5, math.floor(0.58 * height)
    # The raised end, with the ball on it, stays in the picture.
    steepest = math.asin(min(max((middle_y - 2 * radius) / half, 0.05), 0.7))
    angle = min(max(STEEPER * pitch, -steepest), steepest)
    cos, sin = math.cos(angle), math.sin(angle)

    # Of every dot: how far left of and above the middle; along the tray (left is positive) and above its surface.
    left = np.float32(middle_x) - np.arange(width, dtype=np.float32)
    up = np.float32(middle_y) - np.arange(height, dtype=np.float32)[:, None]
    along, above = left * cos - up * sin, left * sin + up * cos

    reach = np.abs(along)
    dots = (above <= 0.5) & (above > -1.5) & (reach <= half)
    dots |= (reach <= half) & (reach > half - 2.0) & (above > -1.0) & (above <= tray.wall * scale)
    dots |= (above <= -2.5) & (above > -4.5) & (reach <= tray.goal_radius * scale)  # where the ball should be
    # The tray turns about its middle, where the ball should be.
    dots |= (up < -3.0) & (up >= -9.0) & (np.abs(left) <= -3.0 - up)
    if scene.ball_along is not None and scene.ball_height is not None:
        ball_along, ball_above = scene.ball_along * scale, (scene.ball_height - tray.surface) * scale
        ball_left, ball_up = ball_along * cos + ball_above * sin, ball_above * cos - ball_along * sin
        ball_up = max(ball_up, middle_y - height + radius)  # a fallen ball lies at the bottom of the picture
        dots |= (left - ball_left) ** 2 + (up - ball_up) ** 2 <= radius ** 2
    return dots
