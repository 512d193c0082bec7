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

"""A robot: its joints and frames, what it can do, the posture it is held in, and how stiffly."""

from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import numpy as np


@dataclass(frozen=True, eq=False)
class Gains:
    """Joint-space PD gains, each of shape (n,)."""

    kp: np.ndarray
    """N m/rad"""
    kd: np.ndarray
    """N m s/rad"""


@dataclass(frozen=True, eq=False)
class RobotSpec:
    """An arm of n joints; all joint vectors have shape (n,), in the order of ``joints``.

    :func:`shared_control.robot.spec_file.load_robot` reads one from its file.
    """

    name: str
    urdf: Path
    """The description that kinematics and dynamics are taken from."""
    joints: tuple[str, ...]
    """Names, as in the URDF and in joint states."""
    base_frame: str
    """Root of the URDF; positions and wrenches are given in it."""
    tool_frame: str
    """Where the wrench acts: a link of the URDF."""
    q_min: np.ndarray
    """Lower joint positions, rad"""
    q_max: np.ndarray
    """Upper joint positions, rad"""
    qd_max: np.ndarray
    """Joint speeds, rad/s"""
    qdd_max: np.ndarray
    """Joint accelerations, rad/s^2"""
    torque_max: np.ndarray
    """Joint torques, N m"""
    torque_rate_max: float
    """Rate of the commanded torque, N m/s"""
    home: np.ndarray
    """Reference joint positions, rad"""
    gains: dict[str, Gains]
    """By name; ``task`` is what tasks are taught with."""
    joint_friction: float = 0.0
    """Coulomb friction of each joint in a simulated world, N m."""
    tool_link: str | None = None
    """URDF of the link that stands in for the one at ``tool_frame`` (:mod:`shared_control.robot.tray`); None: as is."""
    _torque_min: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, '_torque_min', -self.torque_max)

    @property
    def dof(self) -> int:
        """n, the number of joints."""
        return len(self.joints)

    @property
    def description(self) -> str:
        """The URDF as text, with the tool that the robot carries."""
        text = self.urdf.read_text(encoding='utf-8')
        if self.tool_link is None:
            return text
        robot = ElementTree.fromstring(text)
        links = [link.get('name') for link in robot]
        place = links.index(self.tool_frame)
        robot[place] = ElementTree.fromstring(self.tool_link)
        return ElementTree.tostring(robot, encoding='unicode')

    def clamp_torque(self, torque: np.ndarray) -> np.ndarray:
        """``torque`` kept within the joints' limits, (n,), N m."""
        # On a handful of numbers this takes a quarter of np.clip's time.
        limited = np.maximum(torque, self._torque_min)
        return np.minimum(limited, self.torque_max, out=limited)
