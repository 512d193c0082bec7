"""A moment in a wrench message: which components hold it, and what a usable message is."""

import math

import numpy as np
from geometry_msgs.msg import WrenchStamped

from .contract import BASE_FRAME


def base_wrench(frame: str = BASE_FRAME) -> WrenchStamped:
    """A wrench of zero in the base's ``frame``, to be filled in."""
    wrench = WrenchStamped()
    wrench.header.frame_id = frame
    return wrench


def set_moment(wrench: WrenchStamped, moment: np.ndarray) -> None:
    """Write M_y, (1,), N m, in place."""
    wrench.wrench.torque.y = float(moment[0])


def moment_of(wrench: WrenchStamped, frame: str = BASE_FRAME) -> np.ndarray:
    """M_y of a wrench in the base's ``frame``, (1,), N m.

    Raises:
        ValueError: the wrench is given in another frame than the base's, or M_y is not finite; the message says which.
    """
    if wrench.header.frame_id != frame:
        raise ValueError(f'frame_id is {wrench.header.frame_id!r}, expected {frame!r}')
    m_y = wrench.wrench.torque.y
    if not math.isfinite(m_y):
        raise ValueError(f'torque.y is {m_y}')
    return np.array([m_y])
