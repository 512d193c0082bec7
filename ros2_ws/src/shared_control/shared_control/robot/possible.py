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

"""What no arm can be in: joint states that are a fault of whoever sent them, though they may be finite."""

import math

import numpy as np

from .spec import RobotSpec

BEYOND_LIMITS = 20.0 * math.pi
"""Beyond the limits of a joint's position, rad. Ten turns: a simulated joint need not have stops, and drivers count
turns."""
TIMES_AS_FAST = 1000.0
"""As the joint may be. An arm that is thrown about in a simulation stays far below that."""
TIMES_AS_STRONG = 3.0
"""As the joint's torque may be. A driver that reports what its sensors measure has weight and blows in it."""


class PossibleStates:
    """Tells the states that an arm can be in from those that are a fault.

    These are no limits of the robot (:mod:`.reflex`): an arm that violates those is still to be brought to rest. A
    controller that reckons with a state beyond these bounds gets no number at all, or a torque that leaps, since its
    rate is limited against the effort.

    Args:
        spec: the robot.
    """

    def __init__(self, spec: RobotSpec):
        self._spec = spec
        self._bounds = np.concatenate((
            np.maximum(np.abs(spec.q_min), np.abs(spec.q_max)) + BEYOND_LIMITS,
            TIMES_AS_FAST * spec.qd_max, TIMES_AS_STRONG * spec.torque_max))

    def fault(self, *state: np.ndarray) -> str:
        """Which value no arm has, and the bound that it is beyond; empty when there is none.

        Args:
            state: joint positions, rad, then velocities, rad/s, and efforts, N m, or the first of them alone; each
                (n,).
        """
        values = np.concatenate(state)
        possible = np.abs(values) <= self._bounds[:len(values)]  # nan is not, either
        if possible.all():
            return ''
        index = int(possible.argmin())
        quantity, joint = divmod(index, self._spec.dof)
        what, unit = (('position', 'rad'), ('velocity', 'rad/s'), ('effort', 'N m'))[quantity]
        return (f'{what} of {self._spec.joints[joint]} is {values[index]:g} {unit}, which no arm has: at most '
                f'{self._bounds[index]:.0f} are possible')
