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

"""Whether a moment on the tray does on the arm what J^T W predicts: how far the tray tilts about each axis."""

from dataclasses import dataclass

import numpy as np
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.world import World
from shared_control.wrench import AXIS_NAMES

AXES = (3, 4)
"""Moments about base x and base y: rows of the wrench."""
MOMENT = 2.0
"""N m: the arm hardly moves, so that J at the reference posture holds."""
SECONDS = 12.0
"""The slowest joint of the task gains, K_d / K_p = 1.6 s, has come to rest by then."""
AGREEMENT = 0.01
"""Largest difference that counts as agreement, in parts of the predicted tilt."""
_BESIDE_THE_TRAY = np.array([5.0, 0.0, 0.94])


@dataclass(frozen=True)
class Compliance:
    """What a moment about one axis does, deg per N m, about base x and about base y."""

    axis: str
    predicted: tuple[float, float]
    """J K_p^-1 J^T: at rest the springs of the joints hold J^T W."""
    measured: tuple[float, float]

    @property
    def passed(self) -> bool:
        """Whether both agree."""
        most = max(abs(value) for value in self.predicted)
        return all(abs(m - p) <= AGREEMENT * most for m, p in zip(self.measured, self.predicted, strict=True))


def check_compliance(model: RobotModel, world: World) -> list[Compliance]:
    """One check an axis, with the task gains and without a ball."""
    jacobian = model.jacobian(model.spec.home)[list(AXES)].copy()
    predicted = np.degrees(jacobian / model.spec.gains['task'].kp @ jacobian.T)
    still, *tilted = (_tilt(model, world, moment) for moment in np.vstack((np.zeros(2), MOMENT * np.eye(2))))
    return [Compliance(AXIS_NAMES[row], (float(predicted[0, index]), float(predicted[1, index])),
                       tuple(np.degrees((tilted[index] - still) / MOMENT).tolist()))
            for index, row in enumerate(AXES)]


def _tilt(model: RobotModel, world: World, moment: np.ndarray) -> np.ndarray:
    """Rotation of the tray about base x and y after a moment has acted for long, (2,), rad."""
    controller = ComputedTorqueController(model, AXES, dt=CONTROL_PERIOD)
    world.reset(_BESIDE_THE_TRAY)
    for _ in range(round(SECONDS / CONTROL_PERIOD)):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, moment))
    normal = model.tray_pose(world.joint_state()[0])[1][:, 2]
    return np.array([-np.arcsin(normal[1]), np.arcsin(normal[0])])
