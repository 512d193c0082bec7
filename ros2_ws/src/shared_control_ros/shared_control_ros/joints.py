"""Joint positions out of ``/joint_states``."""

import numpy as np
from sensor_msgs.msg import JointState
from shared_control.robot.spec import RobotSpec


def joint_positions(message: JointState, spec: RobotSpec) -> np.ndarray:
    """Positions of the robot's joints, found by name; (n,), rad.

    Raises:
        ValueError: a joint is missing or a position is not finite.
    """
    positions = dict(zip(message.name, message.position, strict=False))
    missing = [name for name in spec.joints if name not in positions]
    if missing:
        raise ValueError(f'no position of {missing[0]!r} among {list(message.name)}')
    q = np.array([positions[name] for name in spec.joints])
    if not np.isfinite(q).all():
        raise ValueError(f'positions that are not finite: {q}')
    return q
