"""The posture the arm is held in, and how stiffly."""

from dataclasses import dataclass

import numpy as np

Q_REFERENCE = np.deg2rad([0.0, -90.0, 0.0, -90.0, 0.0, 179.0, 90.0])
"""Reference joint positions, rad (3.3)."""


@dataclass(frozen=True, eq=False)
class Gains:
    """Joint-space PD gains, each of shape (7,)."""

    kp: np.ndarray
    """N m/rad"""
    kd: np.ndarray
    """N m s/rad"""


GAINS = {
    'task': Gains(
        np.array([200.0, 700.0, 200.0, 500.0, 200.0, 200.0, 200.0]),
        np.array([25.0, 700.0, 25.0, 800.0, 25.0, 25.0, 10.0])),
    'high': Gains(
        np.array([200.0, 1400.0, 200.0, 1400.0, 200.0, 200.0, 200.0]),
        np.array([450.0, 3150.0, 450.0, 3150.0, 450.0, 450.0, 450.0])),
    'low': Gains(
        np.array([35.0, 245.0, 35.0, 245.0, 35.0, 35.0, 35.0]),
        np.array([85.0, 595.0, 85.0, 595.0, 85.0, 85.0, 85.0])),
}
"""``task``: the appendix; ``high`` and ``low``: Table 3, for the validation."""
