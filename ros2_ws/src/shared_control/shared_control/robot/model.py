"""Rigid-body model of arm and tray, from the URDF, by pinocchio."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pinocchio as pin
from panda_tray_description import URDF_PATH

from .limits import JOINT_NAMES

TRAY_FRAME = 'panda_tray'
GRAVITY = 9.81
"""m/s^2"""


class PandaModel:
    """Kinematics and dynamics of the arm with the tray on its flange.

    Joint vectors have shape (7,), in the order of ``JOINT_NAMES``. Results that are arrays may be overwritten by
    the next call: copy what must last.

    Args:
        urdf: the robot's description.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: the file does not have the joints ``panda_joint1..7`` or the frame ``panda_tray``.
    """

    def __init__(self, urdf: Path = URDF_PATH):
        if not Path(urdf).is_file():
            raise FileNotFoundError(f'no robot description at {urdf}')
        self.pin_model = pin.buildModelFromUrdf(str(urdf))
        names = tuple(self.pin_model.names[1:])
        if names != JOINT_NAMES:
            raise ValueError(f'{urdf} has the joints {names}; expected {JOINT_NAMES}')
        if not self.pin_model.existFrame(TRAY_FRAME):
            raise ValueError(f'{urdf} has no frame {TRAY_FRAME!r}')
        self._data = self.pin_model.createData()
        self._tray_id = self.pin_model.getFrameId(TRAY_FRAME)
        frames = self.pin_model.frames
        # A link hangs on a joint's frame, which hangs on the link before it.
        self._links = [
            (frame.name, index, frames[frame.parentFrame].parentFrame) for index, frame in enumerate(frames)
            if frame.type == pin.FrameType.BODY and frame.parentFrame]

    def tray_pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (3,), m, and rotation (3, 3) of the tray frame in the base frame (8, 9)."""
        pin.forwardKinematics(self.pin_model, self._data, q)
        placement = pin.updateFramePlacement(self.pin_model, self._data, self._tray_id)
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
        """Jacobian (6, 7) of the tray frame with the base frame's axes; rows x, y, z, wx, wy, wz (14)."""
        return pin.computeFrameJacobian(
            self.pin_model, self._data, q, self._tray_id, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        """M(q), (7, 7), kg m^2 (15)."""
        upper = np.triu(pin.crba(self.pin_model, self._data, q))
        return upper + np.triu(upper, 1).T

    def inverse_dynamics(self, q: np.ndarray, qd: np.ndarray, qdd: np.ndarray) -> np.ndarray:
        """M(q) qdd + C(q, qd) qd + G(q), (7,), N m, by the recursive Newton-Euler algorithm (15, 16)."""
        return pin.rnea(self.pin_model, self._data, q, qd, qdd)

    def nonlinear_effects(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        """C(q, qd) qd + G(q), (7,), N m, by the recursive Newton-Euler algorithm (28)."""
        return pin.nonLinearEffects(self.pin_model, self._data, q, qd)

    def gravity(self, q: np.ndarray) -> np.ndarray:
        """G(q), (7,), N m."""
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
    """k_w = sqrt(det(J J^T)) (34), in SI units; 0.074 at the reference posture."""
    return float(np.sqrt(max(np.linalg.det(jacobian @ jacobian.T), 0.0)))
