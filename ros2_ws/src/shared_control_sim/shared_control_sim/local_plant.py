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

"""The plant in this process: the same controller and world that the nodes run."""

from typing import Protocol

import numpy as np
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.control.moments import sum_moments
from shared_control.control.sharing import ADDITIVE, Sharing
from shared_control.plant import PlantState
from shared_control.plugins import WORLDS, load
from shared_control.rates import CONTROL_PERIOD, TICKS_PER_ACTION
from shared_control.robot.model import RobotModel
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import BallStarts, Task
from shared_control.world import World


class Person(Protocol):
    """Whoever holds the keys: a simulated tutor, or a script."""

    def reset(self, seed: int | None) -> None:
        """A new episode begins."""

    def moment(self, state: PlantState) -> np.ndarray:
        """The human's moment for the coming period, (k,), N m, by someone who sees ``state``."""


class LocalPlant:
    """World, controller and (if there is one) a person, stepped in a loop.

    Args:
        task: axes, limits, scene and ball starts.
        person: who presses keys; nobody when None.
        physics: its name (entry point of the group ``shared_control.worlds``).
        robot: the robot; the Panda when not given.
        sharing: what counts of the two moments.
        world: another than that of the task and the robot.
        model: what the controller takes the robot for; the robot as it is when not given.

    Raises:
        ValueError: the task cannot be shared like this.
    """

    def __init__(self, task: Task = BALANCE, person: Person | None = None, physics: str = 'bullet',
                 robot: RobotSpec | None = None, sharing: Sharing = ADDITIVE,
                 world: World | None = None, model: RobotModel | None = None):
        sharing.check(len(task.axes))
        self._sharing = sharing
        self.spec = carrying(panda() if robot is None else robot, task.scene)
        self.world: World = world or load(WORLDS, physics)(task.scene, CONTROL_PERIOD, self.spec)
        self.controller = ComputedTorqueController(model or RobotModel(self.spec), task.axes, dt=CONTROL_PERIOD)
        self._person = person
        self._limit = task.limit
        self._none = np.zeros(len(task.axes))
        self._starts = BallStarts(task)
        self._state: PlantState | None = None

    def reset(self, seed: int | None = None) -> PlantState:
        """See :meth:`Plant.reset`."""
        if seed is not None:
            self._starts.seed(seed)
        self.world.reset(self.ball_start())
        if self._person is not None:
            self._person.reset(seed)
        self._state = self._read(self._none, self._none, self._none)
        return self._state

    def ball_start(self) -> np.ndarray:
        """Where the ball is dropped next, base frame, (3,), m."""
        return self._starts.next()

    def advance(self, agent: np.ndarray) -> PlantState:
        """See :meth:`Plant.advance`."""
        assert self._state is not None, 'reset the plant first'
        human = self._none if self._person is None else self._person.moment(self._state)
        agent, human = self._sharing.parts(agent, human)
        applied = sum_moments(agent, human, self._limit)
        for _ in range(TICKS_PER_ACTION):
            self.tick(applied)
        self._state = self._read(human, agent, applied)
        return self._state

    def tick(self, moment: np.ndarray) -> None:
        """One tick of controller and physics with the summed moment, (k,), N m."""
        q, qd = self.world.joint_state()
        self.world.step(self.controller.torque(q, qd, self.world.effort, moment))

    def _read(self, human: np.ndarray, agent: np.ndarray, applied: np.ndarray) -> PlantState:
        position, _, velocity, _ = self.world.ball_state()
        return PlantState(self.world.joint_state()[0], position, velocity, human, agent, applied)

    def close(self) -> None:
        """See :meth:`Plant.close`."""
        self.world.close()
