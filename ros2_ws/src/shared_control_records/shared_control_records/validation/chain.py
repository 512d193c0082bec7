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

"""Forward kinematics by hand: the chain of Table 2 (1)-(9), and what it leaves out of a Panda."""

from functools import reduce

import numpy as np

LINK_LENGTHS = (0.333, 0.316, 0.384, 0.107)
"""l_1, l_3, l_5, l_7 of Table 2, m."""
ELBOW = 0.0825
"""a_4 = -a_5: how far joint 4 lies off the line of joints 3 and 5, m; not in Table 2."""
WRIST = 0.088
"""a_7: how far joint 7 lies off joint 6, m; not in Table 2."""


def yaw(q: float, length: float) -> np.ndarray:
    """Along z by ``length`` (m), then about z by ``q`` (rad): (1), (3), (5), (7); (4, 4)."""
    c, s = np.cos(q), np.sin(q)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, length], [0, 0, 0, 1]])


def pitch(q: float) -> np.ndarray:
    """About y by ``q`` (rad): (2), (4), (6); (4, 4)."""
    c, s = np.cos(q), np.sin(q)
    return np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])


def table_2_chain(q: np.ndarray) -> list[np.ndarray]:
    """The seven transforms of Table 2 (1)-(7); joint positions (7,), rad."""
    l_1, l_3, l_5, l_7 = LINK_LENGTHS
    return [yaw(q[0], l_1), pitch(q[1]), yaw(q[2], l_3), pitch(q[3]), yaw(q[4], l_5), pitch(q[5]), yaw(q[6], l_7)]


def full_chain(q: np.ndarray) -> list[np.ndarray]:
    """The transforms from a Panda's base to its flange, in the same manner; joint positions (7,), rad.

    Beside the two offsets, joints 4 and 6 turn the other way, and the wrist points down at q = 0.
    """
    l_1, l_3, l_5, l_7 = LINK_LENGTHS
    return [yaw(q[0], l_1), pitch(q[1]), yaw(q[2], l_3), _along_x(ELBOW), pitch(-q[3]), _along_x(-ELBOW),
            yaw(q[4], l_5), pitch(-q[5]), _along_x(WRIST), pitch(np.pi), yaw(q[6] + np.pi, l_7)]


def end_pose(chain: list[np.ndarray]) -> np.ndarray:
    """T_0E (8, 9): the product of a chain, (4, 4)."""
    return reduce(np.matmul, chain)


def as_in_table_2(q: np.ndarray) -> np.ndarray:
    """A Panda's joint positions as Table 2 counts them, (7,), rad: without offsets both chains then agree."""
    return np.array([q[0], q[1], q[2], -q[3], q[4], np.pi - q[5], q[6] + np.pi])


def _along_x(length: float) -> np.ndarray:
    transform = np.eye(4)
    transform[0, 3] = length
    return transform
