"""A moment in a wrench message: which components hold it, and what a usable message is."""

import math

from geometry_msgs.msg import WrenchStamped

from .contract import BASE_FRAME


def base_wrench() -> WrenchStamped:
    """A wrench of zero in the base frame, to be filled in."""
    wrench = WrenchStamped()
    wrench.header.frame_id = BASE_FRAME
    return wrench


def set_moment(wrench: WrenchStamped, m_y: float) -> None:
    """Write M_y, N m, in place."""
    wrench.wrench.torque.y = m_y


def moment_of(wrench: WrenchStamped) -> float:
    """M_y of a wrench, N m.

    Raises:
        ValueError: the wrench is given in another frame than the base's, or M_y is not finite; the message says which.
    """
    if wrench.header.frame_id != BASE_FRAME:
        raise ValueError(f'frame_id is {wrench.header.frame_id!r}, expected {BASE_FRAME!r}')
    m_y = wrench.wrench.torque.y
    if not math.isfinite(m_y):
        raise ValueError(f'torque.y is {m_y}')
    return m_y
