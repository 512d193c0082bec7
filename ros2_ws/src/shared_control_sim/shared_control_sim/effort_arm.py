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

"""A Panda as its torque interface shows it: it carries its own weight, and stops by itself when a limit is violated."""

from enum import Enum

import numpy as np
from shared_control.robot.model import RobotModel
from shared_control.robot.reflex import command_violation, state_violation
from shared_control.world import World


class Mode(Enum):
    """libfranka's ``RobotMode``, as far as it matters here."""

    IDLE = 'idle'
    """Held by its brakes; the first command starts the control."""
    MOVE = 'move'
    """Under torque control."""
    REFLEX = 'reflex'
    """Stopped by itself and held by its brakes, until :meth:`EffortPanda.recover`."""


class EffortPanda:
    """Torque control of the arm in a world, as a Panda offers it.

    - The robot adds G(q) itself: commands exclude it, as libfranka's do.
    - A command beyond the limits of torque or of its rate, or a joint beyond those of position or velocity, is
      answered by a reflex: it brakes, and ignores commands until it is told to recover.
    - With ``limit_rate`` a command that is too far from the last one is approached at the rate that is allowed, as
      libfranka's option of that name has it, and is no reason for a reflex.
    - Control starts with a command that it can reach from zero within a tick; what else it hears while idle is
      ignored. A tick without a command keeps the last one; without any for ``command_timeout`` the control ends.

    Args:
        world: arm, tray and ball; one call of :meth:`tick` is one tick of it.
        command_timeout: s.
        limit_rate: see above.
    """

    def __init__(self, world: World, command_timeout: float = 0.1, limit_rate: bool = True):
        self.world = world
        self._step = world.spec.torque_rate_max * world.dt
        self._limit_rate = limit_rate
        self._model = RobotModel(world.spec)
        self._timeout_ticks = round(command_timeout / world.dt)
        self._target = np.zeros(self.world.spec.dof)
        self.limited_ticks = 0
        """Ticks in which ``limit_rate`` held the torque back."""
        self.fault = ''
        """Why it is in :attr:`Mode.REFLEX`, in words."""
        self._enter(Mode.IDLE)

    def _enter(self, mode: Mode) -> None:
        self.mode = mode
        self._silent_ticks = 0
        self.torque = np.zeros(self.world.spec.dof)
        """The torque it was last commanded, without gravity, (n,), N m (libfranka's ``tau_J_d``)."""

    def tick(self, command: np.ndarray | None) -> None:
        """One tick, with the torques ``command`` ((n,), N m) that arrived for it, if any did."""
        q, qd = self.world.joint_state()
        if self.mode is Mode.IDLE and command is not None and self._can_start(command):
            self._enter(Mode.MOVE)
        if self.mode is Mode.MOVE:
            self._follow(command, q, qd)
        if self.mode is Mode.MOVE:
            self.world.step(self.world.spec.clamp_torque(self.torque + self._model.gravity(q)))
        else:
            self.world.step_braked()

    def _can_start(self, command: np.ndarray) -> bool:
        return not command_violation(self.world.spec, command, np.zeros(self.world.spec.dof), self.world.dt)

    def _follow(self, command: np.ndarray | None, q: np.ndarray, qd: np.ndarray) -> None:
        if command is None:
            self._silent_ticks += 1
        else:
            self._target = command
            self._silent_ticks = 0
        if self._silent_ticks > self._timeout_ticks:
            self.stop()
            return
        torque = self._target
        if self._limit_rate:
            torque = np.minimum(np.maximum(torque, self.torque - self._step), self.torque + self._step)
            self.limited_ticks += not np.array_equal(torque, self._target)
        self.fault = (command_violation(self.world.spec, torque, self.torque, self.world.dt)
                      or state_violation(self.world.spec, q, qd))
        if self.fault:
            self._enter(Mode.REFLEX)
        else:
            self.torque = torque

    def stop(self) -> None:
        """End the control: the brakes hold it."""
        if self.mode is Mode.MOVE:
            self._enter(Mode.IDLE)

    def recover(self) -> bool:
        """Leave a reflex (libfranka's ``automaticErrorRecovery``); whether there was one."""
        if self.mode is not Mode.REFLEX:
            return False
        self.fault = ''
        self._enter(Mode.IDLE)
        return True

    def reset(self, ball: np.ndarray) -> None:
        """Put arm and ball back (:meth:`World.reset`), as a person would: the control ends."""
        self.world.reset(ball)
        self.stop()
