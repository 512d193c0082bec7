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

"""What makes an arm stop by itself: limits that its controller watches, with libfranka's names for the errors."""

import numpy as np

from .spec import RobotSpec

_ROUNDING = 1e-6
"""N m: a command may lie exactly on the limit of the rate."""


def command_violation(spec: RobotSpec, torque: np.ndarray, previous: np.ndarray, dt: float) -> str:
    """What is wrong with a commanded torque; empty when nothing is.

    Args:
        spec: the robot.
        torque: the command, (n,), N m.
        previous: the command before it, (n,), N m.
        dt: time between the two, s.
    """
    excess = np.abs(torque) - spec.torque_max
    if excess.max() > _ROUNDING:
        joint = int(excess.argmax())
        return (f'tau_j_range_violation: {spec.joints[joint]} was asked for {torque[joint]:.2f} N m, at most '
                f'{spec.torque_max[joint]:.0f} are allowed')
    jump = np.abs(torque - previous)
    if jump.max() > spec.torque_rate_max * dt + _ROUNDING:
        joint = int(jump.argmax())
        return (f'controller_torque_discontinuity: the torque of {spec.joints[joint]} jumped by {jump[joint]:.2f} N m, '
                f'{spec.torque_rate_max * dt:.2f} are allowed in {1e3 * dt:.0f} ms')
    return ''


def state_violation(spec: RobotSpec, q: np.ndarray, qd: np.ndarray) -> str:
    """Which joint is where it must not be, or too fast; empty when none is. ``q`` (n,), rad; ``qd`` (n,), rad/s."""
    beyond = np.maximum(q - spec.q_max, spec.q_min - q)
    if beyond.max() > 0.0:
        joint = int(beyond.argmax())
        return (f'joint_position_limits_violation: {spec.joints[joint]} is at {q[joint]:.4f} rad, allowed are '
                f'{spec.q_min[joint]} to {spec.q_max[joint]}')
    excess = np.abs(qd) - spec.qd_max
    if excess.max() > 0.0:
        joint = int(excess.argmax())
        return (f'joint_velocity_violation: {spec.joints[joint]} turns at {qd[joint]:.3f} rad/s, at most '
                f'{spec.qd_max[joint]} are allowed')
    return ''
