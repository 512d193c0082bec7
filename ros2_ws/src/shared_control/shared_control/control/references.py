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

"""Joint references that move the tray along base x as a cosine in velocity (22)-(26)."""

from dataclasses import dataclass

import numpy as np

from ..robot.model import RobotModel

AMPLITUDE = 0.05
"""A: how far the tray goes to either side, m (2.4)."""
FREQUENCIES = (0.25, 0.5, 1.0)
"""Hz (2.4)"""


@dataclass(frozen=True, eq=False)
class JointReference:
    """Where the joints are to be, and how fast, at the end of each tick."""

    q: np.ndarray
    """(ticks, n), rad"""
    qd: np.ndarray
    """(ticks, n), rad/s"""


def cosine_velocity(seconds: np.ndarray | float, frequency: float) -> np.ndarray:
    """The tray's velocity along x at a time, m/s: A w cos(w t), w = 2 pi f (25). ``frequency`` in Hz."""
    omega = 2 * np.pi * frequency
    return np.asarray(AMPLITUDE * omega * np.cos(omega * np.asarray(seconds)))


def cosine_reference(model: RobotModel, frequency: float, seconds: float, dt: float) -> JointReference:
    """The reference for ``seconds`` from the reference posture on: qd_ref = J^+ V_e (23), q_ref its integral.

    J is taken at q_ref, so that the reference does not depend on how well it is followed; V_e (26) holds
    :func:`cosine_velocity` along x, taken in the middle of each tick, and zero for the other five.
    """
    ticks = round(seconds / dt)
    q, qd = np.empty((ticks, model.spec.dof)), np.empty((ticks, model.spec.dof))
    twists = np.zeros((ticks, 6))
    twists[:, 0] = cosine_velocity((np.arange(ticks) + 0.5) * dt, frequency)
    now = model.spec.home
    for tick, twist in enumerate(twists):
        qd[tick] = np.linalg.pinv(model.jacobian(now)) @ twist
        q[tick] = now = now + qd[tick] * dt
    return JointReference(q, qd)
