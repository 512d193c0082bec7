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

"""Tray and ball from above, and the moments as arrows in the plane: what a task with two axes is shown as.

Base +x is on the left and -y, away from who looks, at the top: there the left and the up key are to move the ball.
"""

import numpy as np
from shared_control_ros.watching.scene import Moments, Scene

from .canvas import to_lines

_MAX_ROWS = 30
_ARROW = 0.45
"""Length of the arrow of the largest moment that is drawn, in parts of the picture's height."""
_LARGEST = 1.5
"""The largest moment that is drawn, in parts of the human's limit."""


def draw(scene: Scene, width: int, height: int, unicode: bool) -> list[str]:
    """The picture in ``height`` lines of ``width`` characters: left the human's arrow, right the robot's."""
    rows = min(height, _MAX_ROWS)
    if rows < 2 or width < 2:
        return [''] * height
    lines = to_lines(_dots(scene, 2 * width, 4 * rows), unicode)
    if width - 2 * rows > 30:
        lines[-1] = _labelled(lines[-1], scene.hand, 'robot', width)
    above = (height - rows) // 2
    return [''] * above + lines + [''] * (height - rows - above)


def _labelled(line: str, left: str, right: str, width: int) -> str:
    """``line`` with a word under each arrow."""
    text = list(line.ljust(width))
    for word, middle in ((left[:10], width // 8), (right, width - width // 8)):
        start = middle - len(word) // 2
        text[start:start + len(word)] = word
    return ''.join(text)


def _dots(scene: Scene, width: int, height: int) -> np.ndarray:
    """The dots that are set, (height, width), as wide as they are high in most fonts."""
    tray = scene.tray
    scale = 0.48 * min(height, 0.6 * width) / max(tray.half_length, tray.half_width)
    # Of every dot: where it is on the tray, m.
    x = ((width / 2 - 0.5) - np.arange(width)) / scale
    y = (np.arange(height)[:, None] - (height / 2 - 0.5)) / scale
    dot = 1.0 / scale
    off_x, off_y = np.abs(x) - tray.half_length, np.abs(y) - tray.half_width
    dots = (np.maximum(off_x, off_y) <= 0.5 * dot) & (np.maximum(off_x, off_y) > -0.5 * dot)
    for box in tray.boxes:
        if box.is_obstacle:
            thick = np.maximum(np.array(box.size[:2]) / 2, dot)
            dots |= (np.abs(x - box.centre[0]) <= thick[0]) & (np.abs(y - box.centre[1]) <= thick[1])
    from_goal = np.hypot(x - tray.goal[0], y - tray.goal[1])
    dots |= np.abs(from_goal - max(tray.goal_radius, 2 * dot)) <= 0.5 * dot
    if scene.ball_on_tray is not None:
        # A ball that has left the tray lies at the edge of the picture.
        reach = np.array([width, height]) / 2 / scale - tray.ball.radius
        ball = np.clip(scene.ball_on_tray[:2], -reach, reach)
        dots |= np.hypot(x - ball[0], y - ball[1]) <= max(tray.ball.radius, 1.5 * dot)
    side = width / 8
    agent = None if scene.parts is None else scene.parts.agent
    for centre, moment in ((side, scene.human), (width - side, agent)):
        if 2 * side < width / 2 - height / 2 + side and moment is not None:
            dots |= _arrow(scene, moment, centre, width, height)
    return dots


def _arrow(scene: Scene, moment: Moments, middle: float, width: int, height: int) -> np.ndarray:
    """The arrow of a moment, to where it rolls the ball, from a dot at ``middle`` (column)."""
    along = dict(zip(scene.task.axes, moment, strict=True))
    left, up = along.get(4, 0.0), along.get(3, 0.0)
    most = _LARGEST * scene.moment_limit
    tip = np.clip(np.array([-left, -up]) / most, -1.0, 1.0) * _ARROW * height
    column = np.arange(width) - middle
    row = (np.arange(height) - (height / 2 - 0.5))[:, None]
    length = float(np.hypot(*tip))
    dots = np.hypot(column, row) <= 1.0
    if length < 1.0:
        return dots
    ahead = (column * tip[0] + row * tip[1]) / length
    beside = np.abs(column * tip[1] - row * tip[0]) / length
    shaft = (ahead >= 0) & (ahead <= length) & (beside <= 0.6)
    head = (ahead <= length) & (ahead >= length - 5.0) & (beside <= 0.8 * (length - ahead))
    return np.asarray(dots | shaft | head)
