"""What the Panda can do: Table 1 of the thesis, and the torque rate of libfranka."""

import numpy as np

DOF = 7

JOINT_NAMES = tuple(f'panda_joint{i}' for i in range(1, DOF + 1))

Q_MAX = np.array([2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973])
"""Upper joint positions, rad (Table 1)."""

Q_MIN = np.array([-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973])
"""Lower joint positions, rad (Table 1)."""

QD_MAX = np.array([2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61])
"""Joint speeds, rad/s (Table 1)."""

QDD_MAX = np.array([15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0])
"""Joint accelerations, rad/s^2 (Table 1)."""

TORQUE_MAX = np.array([87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0])
"""Joint torques, N m (Table 1)."""

TORQUE_RATE_MAX = 1000.0
"""Rate of the commanded torque, N m/s (libfranka, ``kMaxTorqueRate``): 1 N m a tick at 1 kHz."""

_TORQUE_MIN = -TORQUE_MAX


def clamp_torque(torque: np.ndarray) -> np.ndarray:
    """``torque`` kept within the joints' limits, (7,), N m."""
    # On seven numbers this takes a quarter of np.clip's time.
    limited = np.maximum(torque, _TORQUE_MIN)
    return np.minimum(limited, TORQUE_MAX, out=limited)
