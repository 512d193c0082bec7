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

"""A square plate with walls, of any size, with or without something on it: the one source of its geometry.

Worlds, the robot's description with the plate's inertia (:mod:`shared_control.robot.tray`), screens and reports are
made of it.
"""

from ...scene import Box, Scene

SIDE = 0.3
"""Side of the surface, m."""
THICKNESS = 0.006
"""Thickness of the plate, m."""
WALL = 0.01
"""Height of the walls, m: less than the ball is high, so that it can be lost."""
WALL_THICKNESS = 0.005
"""m"""
ACRYLIC_GLASS = 1190.0
"""kg/m^3"""


def plate_scene(side: float = SIDE, obstacles: tuple[Box, ...] = (), goal: tuple[float, float] = (0.0, 0.0),
                goal_radius: float = 0.02) -> Scene:
    """A plate of ``side`` (m) with ``obstacles`` on it, and where the ball should be (:class:`Scene`)."""
    half, outside = side / 2, side + 2 * WALL_THICKNESS
    at, height = half + WALL_THICKNESS / 2, THICKNESS + WALL / 2
    return Scene(
        half_length=half, half_width=half, surface=THICKNESS, wall=WALL, goal_radius=goal_radius, goal=goal,
        density=ACRYLIC_GLASS, home=(-0.4846, 0.0, 0.94),
        boxes=(
            Box((0.0, 0.0, THICKNESS / 2), (outside, outside, THICKNESS)),
            *(Box((sign * at, 0.0, height), (WALL_THICKNESS, outside, WALL)) for sign in (1, -1)),
            *(Box((0.0, sign * at, height), (side, WALL_THICKNESS, WALL)) for sign in (1, -1)),
            *obstacles))


PLATE_SCENE = plate_scene()
"""30 x 30 cm."""
