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

"""Stands in for panda-python where there is no arm: the few calls that the bridge makes, with their signatures.

Behind them is the Panda of shared_control's world, which steps whenever it is looked at, up to the present.
``hostname`` "nobody" does not answer; "far" has an elbow that stands half a radian off the reference; "slow" takes two
seconds until it is under control. Once it is under control, "unstoppable" stays so, the time of "frozen" stands still,
and "lost" does not answer any more.
"""

import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from shared_control.robot.spec_file import panda
from shared_control.scene import Ball
from shared_control.tasks.balance import BALANCE
from shared_control_sim.bullet import BulletWorld
from shared_control_sim.effort_arm import EffortPanda, Mode

from . import controllers

__all__ = ['Panda', 'controllers']

MODES = {Mode.IDLE: 'kIdle', Mode.MOVE: 'kMove', Mode.REFLEX: 'kReflex'}


class Panda:
    """As panda_py.Panda."""

    def __init__(self, hostname):
        if hostname == 'nobody':
            raise RuntimeError('libfranka: Connection to FCI refused.')
        # With next to nothing on the tray the arm stays where it is under zero torque.
        off = np.eye(7)[3] * (0.5 if hostname == 'far' else 0.0)
        self._robot = EffortPanda(BulletWorld(
            replace(BALANCE.scene, ball=Ball(mass=1e-6)), spec=replace(panda(), home=panda().home + off)))
        self._start_seconds = 2.0 if hostname == 'slow' else 0.0
        self._began = time.monotonic()
        self._ticks = 0
        self._controller = None
        self._hostname = hostname
        self._was_started = False

    def _catch_up(self):
        while self._ticks < (time.monotonic() - self._began) * 1000:
            self._robot.tick(None if self._controller is None else self._controller.torque)
            self._ticks += 1

    def get_state(self):
        if self._controller is None:
            time.sleep(0.001)  # until the next state comes
        if self._was_started and self._hostname == 'lost':
            raise RuntimeError('libfranka: UDP receive: Timeout')
        if not (self._was_started and self._hostname == 'frozen'):
            self._catch_up()
        q, qd = self._robot.world.joint_state()
        return SimpleNamespace(
            time=SimpleNamespace(to_msec=lambda: self._ticks), q=list(q), dq=list(qd),
            tau_J_d=list(self._robot.torque), robot_mode=SimpleNamespace(name=MODES[self._robot.mode]))

    def start_controller(self, controller):
        controller.torque = np.zeros(7)
        time.sleep(self._start_seconds)
        self._controller = controller
        self._was_started = True
        self._robot.tick(controller.torque)  # the control begins with zero, whatever is set next
        self._ticks += 1

    def stop_controller(self):
        if self._hostname == 'unstoppable':
            raise RuntimeError('libfranka: stop failed')
        self._controller = None
        self._robot.stop()

    def raise_error(self):
        if self._robot.mode is Mode.REFLEX:
            raise RuntimeError(f'libfranka: Move command aborted: motion aborted by reflex! [{self._robot.fault}]')

    def recover(self):
        self._robot.recover()
