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

"""Rigid-body model of an arm and its tool, from the URDF, by pinocchio."""

from collections.abc import Iterator

import numpy as np
import pinocchio as pin

from .spec import RobotSpec
from .spec_file import panda

GRAVITY = 9.81
"""m/s^2"""


class RobotModel:
    """Kinematics and dynamics of an arm with what is on its flange.

    Joint vectors have shape (n,), in the order of ``spec.joints``. Results that are arrays may be overwritten by
    the next call: copy what must last.

    Args:
        spec: the robot; the Panda when not given.
        description: a URDF of it with other inertias; its own when not given.

    Raises:
        ValueError: the joints of its URDF are others, or in another order, or do not have one position each.
    """

    def __init__(self, spec: RobotSpec | None = None, description: str | None = None):
        self.spec = spec = panda() if spec is None else spec
        self.pin_model = pin.buildModelFromXML(description or spec.description)
        names = tuple(self.pin_model.names[1:])
        if names != spec.joints:
            raise ValueError(f'{spec.urdf} has the joints {names}; expected {spec.joints}')
        if self.pin_model.nq != spec.dof:
            raise ValueError(f'{spec.urdf}: a joint is continuous; give it limits (type revolute)')
        self._data = self.pin_model.createData()
        self._tool_id = self.pin_model.getFrameId(spec.tool_frame, pin.FrameType.BODY)  # a joint may have its name
        frames = self.pin_model.frames
        # A link hangs on a joint's frame, which hangs on the link before it.
        self._links = [
            (frame.name, index, frames[frame.parentFrame].parentFrame) for index, frame in enumerate(frames)
            if frame.type == pin.FrameType.BODY and frame.parentFrame]

    def tray_pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (3,), m, and rotation (3, 3) of the tool frame (the tray) in the base frame (8, 9)."""
        pin.forwardKinematics(self.pin_model, self._data, q)
        placement = pin.updateFramePlacement(self.pin_model, self._data, self._tool_id)
        return placement.translation, placement.rotation

    def link_transforms(self, q: np.ndarray) -> Iterator[tuple[str, str, np.ndarray, np.ndarray]]:
        """Every link in the frame of the link before it, as in the URDF's tree.

        Yields:
            Names of parent and child, position (3,), m, and quaternion (4,), x y z w.
        """
        pin.framesForwardKinematics(self.pin_model, self._data, q)
        for name, index, parent in self._links:
            placement = self._data.oMf[parent].actInv(self._data.oMf[index])
            yield (self.pin_model.frames[parent].name, name, placement.translation,
                   quaternion_of(placement.rotation))

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """Jacobian (6, n) of the tool frame with the base frame's axes; rows x, y, z, wx, wy, wz (14)."""
        return pin.computeFrameJacobian(
            self.pin_model, self._data, q, self._tool_id, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)

    def manipulability(self, q: np.ndarray) -> float:
        """:func:`manipulability` of the Jacobian."""
        return manipulability(self.jacobian(q))

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        """M(q), (n, n), kg m^2 (15)."""
        upper = np.triu(pin.crba(self.pin_model, self._data, q))
        return upper + np.triu(upper, 1).T

    def inverse_dynamics(self, q: np.ndarray, qd: np.ndarray, qdd: np.ndarray) -> np.ndarray:
        """M(q) qdd + C(q, qd) qd + G(q), (n,), N m, by the recursive Newton-Euler algorithm (15, 16)."""
        return pin.rnea(self.pin_model, self._data, q, qd, qdd)

    def nonlinear_effects(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        """C(q, qd) qd + G(q), (n,), N m, by the recursive Newton-Euler algorithm (28)."""
        return pin.nonLinearEffects(self.pin_model, self._data, q, qd)

    def gravity(self, q: np.ndarray) -> np.ndarray:
        """G(q), (n,), N m."""
        return pin.computeGeneralizedGravity(self.pin_model, self._data, q)


def quaternion_of(rotation: np.ndarray) -> np.ndarray:
    """Quaternion (4,), x y z w, of a rotation matrix (3, 3)."""
    return pin.Quaternion(rotation).coeffs()


def pitch(rotation: np.ndarray) -> float:
    """Pitch about base y of a frame whose z axis points up, rad (the appendix' ``eulerXYZAng[1]``).

    Positive tilts the side towards +x down.
    """
    return float(np.arctan2(rotation[0, 2], np.hypot(rotation[1, 2], rotation[2, 2])))


def manipulability(jacobian: np.ndarray) -> float:
    """k_w = sqrt(det(J J^T)) (34), in SI units; 0.074 at the Panda's reference posture."""
    return float(np.sqrt(max(np.linalg.det(jacobian @ jacobian.T), 0.0)))
