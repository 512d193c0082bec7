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

"""A plant in this process that is not as it was when the policy was taught."""

from dataclasses import replace

import numpy as np
from shared_control.control.sharing import ADDITIVE, Sharing
from shared_control.plugins import WORLDS, load
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.inertials import with_fer_inertials, with_masses_times
from shared_control.robot.model import RobotModel
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import askew, carrying
from shared_control.tasks.task import Task

from .changes import Change
from .local_plant import LocalPlant, Person
from .poor_senses import PoorSenses


class ChangedPlant(LocalPlant):
    """A :class:`LocalPlant` whose world, or whose controller's model, was changed without telling anybody.

    Success is judged by where the tray would be if it were mounted as it should be.

    Args:
        task: what is done.
        change: what is otherwise.
        person, physics, robot, sharing: see :class:`LocalPlant`.

    Raises:
        ValueError: there are no such inertias for this robot.
    """

    def __init__(self, task: Task, change: Change, person: Person | None = None, physics: str = 'bullet',
                 robot: RobotSpec | None = None, sharing: Sharing = ADDITIVE):
        spec = carrying(panda() if robot is None else robot, task.scene)
        real = replace(spec, joint_friction=change.joint_friction)
        if change.askew:
            real = replace(real, tool_link=askew(real, change.askew))
        scene = task.scene if change.ball is None else replace(task.scene, ball=change.ball)
        world = load(WORLDS, physics)(replace(scene, density=None), CONTROL_PERIOD, real)
        super().__init__(task, person, physics, robot, sharing, world, _model(spec, change))
        self._higher = np.array([0.0, 0.0, scene.ball.radius - task.scene.ball.radius])

    def ball_start(self) -> np.ndarray:
        """See :class:`LocalPlant`: as far above the tray as a ball that is not changed."""
        return super().ball_start() + self._higher


def senses_of(change: Change) -> PoorSenses | None:
    """How a learner perceives a plant with this change; perfectly when None."""
    return PoorSenses(change.late, change.noise) if change.late or change.noise else None


def _model(spec: RobotSpec, change: Change) -> RobotModel:
    if change.model_is_fer:
        return RobotModel(spec, with_fer_inertials(spec))
    return RobotModel(spec) if change.model_masses == 1.0 else RobotModel(
        spec, with_masses_times(spec, change.model_masses))
