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

"""The physical world that a simulated robot lives in."""

from typing import Protocol

import numpy as np

from .robot.spec import RobotSpec


class World(Protocol):
    """An arm that takes joint torques, a tray on its flange and a ball, one tick at a time.

    Made from a :class:`Scene`, the length of a tick, s, and a :class:`RobotSpec`; found by name (entry point of
    ``shared_control.worlds``).

    An episode depends on nothing that came before it, and two worlds given the same torques from the same start go
    through the same states, bit for bit. Vectors are in the base frame, in SI units.
    """

    spec: RobotSpec
    """The robot."""
    dt: float
    """Length of a tick, s."""
    effort: np.ndarray
    """The torque applied in the last tick, (n,), N m; after a reset the one that holds the arm."""

    def reset(self, ball: np.ndarray) -> None:
        """Arm at rest at the reference joints, ball at rest at ``ball``, (3,), m."""

    def joint_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Joint positions, rad, and velocities, rad/s, each (n,)."""

    def ball_state(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """The ball: position, m; quaternion x y z w; velocity, m/s; angular velocity, rad/s."""

    def push(self, force: np.ndarray) -> None:
        """Push the tray's origin with ``force`` ((3,), N) from the next tick on, until called again."""

    def step(self, torque: np.ndarray) -> None:
        """One tick with joint torques ``torque``, (n,), N m: within the joints' limits, as the controller gives them.

        Whoever takes torques from elsewhere keeps them there (:meth:`RobotSpec.clamp_torque`).
        """

    def step_braked(self) -> None:
        """One tick without a command: the joints' brakes hold them."""

    def close(self) -> None:
        """Free the physics engine; it may be free already."""
