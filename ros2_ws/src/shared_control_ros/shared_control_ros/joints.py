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

"""Joint positions out of ``/joint_states``."""

from functools import cache

import numpy as np
from sensor_msgs.msg import JointState
from shared_control.robot.possible import PossibleStates
from shared_control.robot.spec import RobotSpec

_possible = cache(PossibleStates)
"""The bounds of a robot; positions come up to a hundred times a second."""


def joint_positions(message: JointState, spec: RobotSpec) -> np.ndarray:
    """Positions of the robot's joints, found by name; (n,), rad.

    Raises:
        ValueError: a joint is missing, or its position is one that no arm has.
    """
    positions = dict(zip(message.name, message.position, strict=False))
    missing = [name for name in spec.joints if name not in positions]
    if missing:
        raise ValueError(f'no position of {missing[0]!r} among {list(message.name)}')
    q = np.array([positions[name] for name in spec.joints])
    if fault := _possible(spec).fault(q):
        raise ValueError(fault)
    return q
