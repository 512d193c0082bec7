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

"""The arm as panda-python reaches it. Nothing else here knows that library, and it is loaded only when it is needed."""

from dataclasses import dataclass
from typing import Any

import numpy as np

IDLE = 'kIdle'
"""libfranka's ``RobotMode`` of an arm that is ready to be moved."""


class ArmError(OSError):
    """The arm cannot be reached or stopped; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class ArmState:
    """What the arm reported last."""

    time_ms: int
    """Time by the arm's own clock."""
    q: np.ndarray
    """Joint positions, (7,), rad"""
    qd: np.ndarray
    """Joint velocities, (7,), rad/s"""
    torque: np.ndarray
    """``tau_J_d``: the torque it was last commanded, without gravity, (7,), N m"""
    mode: str
    """Name of libfranka's ``RobotMode``"""


class Arm:
    """A Panda at ``hostname``.

    Raises:
        ArmError: panda-python is not installed, or the arm does not answer.
    """

    def __init__(self, hostname: str):
        try:
            import panda_py
            from panda_py import controllers
        except ImportError as error:
            raise ArmError(
                f'panda-python cannot be imported ({error}): pip install panda-python==1.1.1 (with libfranka 0.9.2, '
                'for the Panda), or use mock_panda_node') from error
        self._make_controller = controllers.AppliedTorque
        self._controller: Any = None
        try:
            self._panda = panda_py.Panda(hostname)
        except RuntimeError as error:
            raise ArmError(f'no Panda at {hostname}: {error}') from error

    def read(self) -> ArmState:
        """The newest state; while the arm is not under control this waits for the next one, a millisecond.

        Raises:
            ArmError: the arm does not answer any more.
        """
        try:
            state = self._panda.get_state()
        except RuntimeError as error:
            raise ArmError(f'the arm does not answer any more: {error}') from error
        return ArmState(state.time.to_msec(), np.array(state.q), np.array(state.dq), np.array(state.tau_J_d),
                        state.robot_mode.name)

    def start(self) -> None:
        """Take the arm under torque control, beginning with zero; panda-python limits torques and their rate.

        Raises:
            RuntimeError: the arm refuses.
        """
        controller = self._make_controller()
        self._panda.start_controller(controller)
        self._controller = controller

    def command(self, torque: np.ndarray) -> None:
        """The torque to apply from now on, (7,), N m, without gravity."""
        self._controller.set_control(torque)

    def failure(self) -> str:
        """Why the control has ended by itself; empty while it goes on."""
        try:
            self._panda.raise_error()
        except RuntimeError as error:
            return str(error)
        return ''

    def stop(self) -> None:
        """End the control: the arm holds itself.

        Raises:
            ArmError: it goes on with its last torque, for as long as this process lives.
        """
        if self._controller is None:
            return
        try:
            self._panda.stop_controller()
        except RuntimeError as error:
            raise ArmError(f'the control did not end ({error}): it ends with this process, now') from error
        self._controller = None

    def recover(self) -> None:
        """Leave a reflex.

        Raises:
            RuntimeError: the arm refuses.
        """
        self._panda.recover()
