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

"""Tracks on a tray, seen from above: what a task with two axes is drawn as."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle
from shared_control.scene import Scene

from ..plotting.style import FAINT, GOOD, INK


def draw_tray(axes: Axes, scene: Scene) -> None:
    """The tray with its obstacles and the goal, in cm; +x is on the left and -y at the top, as on the screens."""
    half_x, half_y = 100 * scene.half_length, 100 * scene.half_width
    axes.set(xlim=(1.08 * half_x, -1.08 * half_x), ylim=(1.08 * half_y, -1.08 * half_y), aspect='equal',
             xlabel='x (cm)', ylabel='y (cm)')
    axes.grid(visible=False)
    for side in axes.spines.values():
        side.set_visible(False)
    axes.add_patch(Rectangle((-half_x, -half_y), 2 * half_x, 2 * half_y, fill=False, edgecolor=FAINT, linewidth=2))
    for box in scene.boxes:
        if box.is_obstacle:
            size, centre = 100 * np.array(box.size[:2]), 100 * np.array(box.centre[:2])
            axes.add_patch(Rectangle(tuple(centre - size / 2), *size.tolist(), color=INK))
    axes.add_patch(Circle(tuple(100 * np.array(scene.goal)), 100 * scene.goal_radius, fill=False, edgecolor=GOOD,
                          linewidth=2.5, zorder=3))


def draw_track(axes: Axes, scene: Scene, track: np.ndarray, colour: object, alpha: float, is_lost: bool) -> None:
    """One ball's way from its ring to its point, or to the cross where it was lost; ``track`` (n, 2), m."""
    edge = 1.05 * np.array([scene.half_length, scene.half_width])
    way = 100 * np.clip(track, -edge, edge)
    axes.plot(*way.T, color=colour, alpha=alpha, linewidth=1.3)
    axes.plot(*way[0], 'o', color=colour, alpha=alpha, markersize=4, fillstyle='none')
    axes.plot(*way[-1], 'x' if is_lost else 'o', color=colour, alpha=alpha, markersize=8 if is_lost else 5,
              markeredgewidth=2.5 if is_lost else 1.0)
