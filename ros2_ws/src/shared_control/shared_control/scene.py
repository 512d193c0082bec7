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

"""The geometry of a task: everything that there is to see and touch, once."""

from dataclasses import dataclass

BALL_WITHIN = 1e9
"""No ball is further off, m, or faster, m/s: in a world without a floor one falls for four hours until then."""


@dataclass(frozen=True)
class Box:
    """A box in the tray's frame, with its axes."""

    centre: tuple[float, float, float]
    """m"""
    size: tuple[float, float, float]
    """m"""
    is_obstacle: bool = False
    """In the ball's way, and so drawn apart from what carries it."""


@dataclass(frozen=True)
class Ball:
    """The ball of the thesis (3.1)."""

    mass: float = 0.17
    """kg"""
    radius: float = 0.015
    """m, as the appendix runs it (the text says 1.5 cm in diameter)"""
    friction: float = 0.8
    """Coulomb coefficient against the tray; there is no rolling friction."""


@dataclass(frozen=True)
class Scene:
    """A tray on the arm's flange, and a ball on it.

    Positions on the tray are in the tray's frame: x and y along its sides, z out of its surface.
    """

    half_length: float
    """Half the surface's length along the tray's x, m."""
    half_width: float
    """Half the surface's width along the tray's y, m."""
    surface: float
    """Height of the surface above the tray's origin, m."""
    wall: float
    """Height of the walls above the surface, m."""
    boxes: tuple[Box, ...]
    """What the tray is made of."""
    home: tuple[float, float, float]
    """Where a ball is dropped onto the middle of the tray, with the arm at its reference joints, base frame, m."""
    goal_radius: float
    """How near the goal the ball is where it should be, m."""
    goal: tuple[float, float] = (0.0, 0.0)
    """Where the ball should be, in the tray's frame, m."""
    density: float | None = None
    """Density of what the tray is made of, kg/m^3; None: the tray is the one that the robot's own description has."""
    ball: Ball = Ball()
