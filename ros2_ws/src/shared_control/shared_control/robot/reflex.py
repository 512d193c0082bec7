"""What makes a Panda stop by itself: limits that its controller watches, with libfranka's names for the errors."""

import numpy as np

from .limits import JOINT_NAMES, Q_MAX, Q_MIN, QD_MAX, TORQUE_MAX, TORQUE_RATE_MAX

_ROUNDING = 1e-6
"""N m: a command may lie exactly on the limit of the rate."""


def command_violation(torque: np.ndarray, previous: np.ndarray, dt: float) -> str:
    """What is wrong with a commanded torque; empty when nothing is.

    Args:
        torque: the command, (7,), N m.
        previous: the command before it, (7,), N m.
        dt: time between the two, s.
    """
    excess = np.abs(torque) - TORQUE_MAX
    if excess.max() > _ROUNDING:
        joint = int(excess.argmax())
        return (f'tau_j_range_violation: {JOINT_NAMES[joint]} was asked for {torque[joint]:.2f} N m, at most '
                f'{TORQUE_MAX[joint]:.0f} are allowed')
    jump = np.abs(torque - previous)
    if jump.max() > TORQUE_RATE_MAX * dt + _ROUNDING:
        joint = int(jump.argmax())
        return (f'controller_torque_discontinuity: the torque of {JOINT_NAMES[joint]} jumped by {jump[joint]:.2f} N m, '
                f'{TORQUE_RATE_MAX * dt:.2f} are allowed in {1e3 * dt:.0f} ms')
    return ''


def state_violation(q: np.ndarray, qd: np.ndarray) -> str:
    """Which joint is where it must not be, or too fast; empty when none is. ``q`` (7,), rad; ``qd`` (7,), rad/s."""
    beyond = np.maximum(q - Q_MAX, Q_MIN - q)
    if beyond.max() > 0.0:
        joint = int(beyond.argmax())
        return (f'joint_position_limits_violation: {JOINT_NAMES[joint]} is at {q[joint]:.4f} rad, allowed are '
                f'{Q_MIN[joint]} to {Q_MAX[joint]}')
    excess = np.abs(qd) - QD_MAX
    if excess.max() > 0.0:
        joint = int(excess.argmax())
        return (f'joint_velocity_violation: {JOINT_NAMES[joint]} turns at {qd[joint]:.3f} rad/s, at most '
                f'{QD_MAX[joint]} are allowed')
    return ''
