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

"""Inverse dynamics by the recursive Newton-Euler algorithm (16)-(21), as the textbook has it.

J. J. Craig, Introduction to Robotics: Mechanics and Control, section 6.5. The thesis' own (17)-(21) cannot be
implemented as printed: (17) has ``qdd x r`` where the angular acceleration of the link belongs, (20) asks for
velocities of the centres of mass that nothing defines, and (21) has neither the moments of the forces nor those of the
next link. The equation numbers below name the places where the textbook's formulas belong.
"""

import numpy as np
import pinocchio as pin
from shared_control.robot.model import GRAVITY

_Z = np.array([0.0, 0.0, 1.0])


def newton_euler(model: pin.Model, q: np.ndarray, qd: np.ndarray, qdd: np.ndarray,
                 force: np.ndarray, moment: np.ndarray) -> np.ndarray:
    """tau = NewtonEuler(q, qd, qdd, f_e, m_e) (16), (n,), N m.

    Args:
        model: where the joints' placements and the links' masses, centres and inertias are taken from; its
            algorithms are not used.
        q, qd, qdd: joint positions, velocities and accelerations, (n,), rad, rad/s, rad/s^2.
        force, moment: what the surroundings exert on the last link at the origin of its frame, with that frame's axes,
            (3,), N and N m.
    """
    rotations, origins = _joints(model, q)
    inertias = [model.inertias[i + 1] for i in range(len(q))]
    omega, alpha, acceleration = np.zeros(3), np.zeros(3), GRAVITY * _Z  # a base that falls upwards is gravity
    forces, moments = [], []
    for i in range(len(q)):
        to_link = rotations[i].T
        acceleration = to_link @ (
            acceleration + np.cross(alpha, origins[i]) + np.cross(omega, np.cross(omega, origins[i])))  # (17)
        omega_before = to_link @ omega
        alpha = to_link @ alpha + np.cross(omega_before, qd[i] * _Z) + qdd[i] * _Z  # (18)
        omega = omega_before + qd[i] * _Z
        centre, inertia = inertias[i].lever, inertias[i].inertia
        forces.append(inertias[i].mass * (
            acceleration + np.cross(alpha, centre) + np.cross(omega, np.cross(omega, centre))))  # (19), (20)
        moments.append(inertia @ alpha + np.cross(omega, inertia @ omega))

    tau = np.zeros(len(q))
    force, moment = -force, -moment  # what the last link exerts on its surroundings
    for i in reversed(range(len(q))):
        force = forces[i] + force
        moment = moments[i] + np.cross(inertias[i].lever, forces[i]) + moment
        tau[i] = moment @ _Z  # (21)
        force = rotations[i] @ force
        moment = rotations[i] @ moment + np.cross(origins[i], force)
    return tau


def _joints(model: pin.Model, q: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Rotation and origin of each link's frame in the one before it."""
    rotations, origins = [], []
    for i in range(len(q)):
        placement = model.jointPlacements[i + 1]
        c, s = np.cos(q[i]), np.sin(q[i])
        rotations.append(placement.rotation @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
        origins.append(placement.translation)
    return rotations, origins
