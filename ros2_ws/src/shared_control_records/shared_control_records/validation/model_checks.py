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

"""Kinematics and dynamics against what was written down independently of them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from shared_control.robot.model import RobotModel, manipulability
from shared_control.robot.spec_file import panda

from .chain import as_in_table_2, end_pose, full_chain, table_2_chain
from .newton_euler import newton_euler

BOUND = 1e-9
"""What counts as agreement, in the unit of each check."""
STATES = 200
"""Random postures of a check, uniform within the limits of Table 1."""
DIFFERENCE = 1e-5
"""Half the step of the central differences, rad."""
_SEED = 24


@dataclass(frozen=True)
class Check:
    """The largest difference between two ways to compute the same."""

    name: str
    difference: float
    unit: str

    @property
    def passed(self) -> bool:
        """Whether both agree."""
        return self.difference <= BOUND


@dataclass(frozen=True)
class HomeFigures:
    """What the reference posture looks like."""

    table_2_flange: tuple[float, float, float]
    """Where Table 2 has the end effector, m"""
    flange: tuple[float, float, float]
    """Where it is, m"""
    distance: float
    """Between the two, m"""
    manipulability: float
    """k_w = sqrt(det(J J^T)) (34), in SI units"""
    one_minus_manipulability_squared: float
    """1 - k_w^2, as the appendix has it"""


def check_model(model: RobotModel) -> list[Check]:
    """All checks of the model."""
    checks: tuple[tuple[str, str, Callable[[RobotModel, np.random.Generator], float]], ...] = (
        ('Table 2, (1)-(9), and the URDF without offsets: flange', 'm, and entries of R', _table_2),
        ('full chain by hand and the URDF: flange', 'm, and entries of R', _full_chain),
        ('Jacobian (14) and differences of the chain by hand (11)-(13)', 'm, and 1', _jacobian),
        ('tau by Newton-Euler (16)-(21) and by pinocchio', 'N m', _dynamics),
        ('manipulability: sqrt(det(J J^T)) (34) and product of singular values', '1', _manipulability),
    )
    return [Check(name, check(model, np.random.default_rng(_SEED)), unit) for name, unit, check in checks]


def home_figures(model: RobotModel) -> HomeFigures:
    """The reference posture, by Table 2 and as it is."""
    table_2, full = (end_pose(chain(model.spec.home))[:3, 3] for chain in (table_2_chain, full_chain))
    k_w = model.manipulability(model.spec.home)
    return HomeFigures(
        tuple(table_2.tolist()), tuple(full.tolist()), float(np.linalg.norm(table_2 - full)), k_w, 1 - k_w ** 2)


def _postures(random: np.random.Generator) -> Iterator[np.ndarray]:
    return (random.uniform(panda().q_min, panda().q_max) for _ in range(STATES))


def _flange(model: pin.Model, data: pin.Data, q: np.ndarray) -> np.ndarray:
    """Pose of the flange by pinocchio, (4, 4)."""
    pin.forwardKinematics(model, data, q)
    return pin.updateFramePlacement(model, data, model.getFrameId('panda_link8')).homogeneous


def _table_2(model: RobotModel, random: np.random.Generator) -> float:
    straight = pin.Model(model.pin_model)
    for placement in straight.jointPlacements:
        placement.translation[0] = 0.0  # a_4, a_5, a_7: all lie along x
    data = straight.createData()
    return max(
        _largest(_flange(straight, data, q) - end_pose(table_2_chain(as_in_table_2(q)))) for q in _postures(random))


def _full_chain(model: RobotModel, random: np.random.Generator) -> float:
    data = model.pin_model.createData()
    return max(_largest(_flange(model.pin_model, data, q) - end_pose(full_chain(q))) for q in _postures(random))


def _jacobian(model: RobotModel, random: np.random.Generator) -> float:
    # The tray's frame sits at the flange's origin: same Jacobian in the base's axes.
    return max(_largest(model.jacobian(q) - _difference_jacobian(q)) for q in _postures(random))


def _difference_jacobian(q: np.ndarray) -> np.ndarray:
    """(11)-(13) by central differences, (6, 7)."""
    columns = []
    for joint in range(len(q)):
        step = np.zeros(len(q))
        step[joint] = DIFFERENCE
        derivative = (end_pose(full_chain(q + step)) - end_pose(full_chain(q - step))) / (2 * DIFFERENCE)
        spin = derivative[:3, :3] @ end_pose(full_chain(q))[:3, :3].T  # (13)
        columns.append([*derivative[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]])
    return np.array(columns).T


def _dynamics(model: RobotModel, random: np.random.Generator) -> float:
    """At random speeds and accelerations, with a random wrench at the tray's origin as in (15)."""
    data = model.pin_model.createData()
    tray = model.pin_model.frames[model.pin_model.getFrameId(model.spec.tool_frame)].placement
    worst = 0.0
    for q in _postures(random):
        qd, qdd = (random.uniform(-most, most) for most in (model.spec.qd_max, model.spec.qdd_max))
        wrench = random.uniform(-50, 50, 6)
        theirs = pin.rnea(model.pin_model, data, q, qd, qdd) - model.jacobian(q).T @ wrench
        to_link = (model.tray_pose(q)[1] @ tray.rotation.T).T
        force = to_link @ wrench[:3]
        moment = to_link @ wrench[3:] + np.cross(tray.translation, force)
        worst = max(worst, _largest(theirs - newton_euler(model.pin_model, q, qd, qdd, force, moment)))
    return worst


def _manipulability(model: RobotModel, random: np.random.Generator) -> float:
    def difference(q: np.ndarray) -> float:
        jacobian = model.jacobian(q)
        return abs(manipulability(jacobian) - float(np.prod(np.linalg.svd(jacobian, compute_uv=False))))
    return max(difference(q) for q in _postures(random))


def _largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())
