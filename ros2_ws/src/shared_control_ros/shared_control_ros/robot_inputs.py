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

"""What a robot in a simulated world receives: torques, pushes at the tray."""

import math

import numpy as np
from rclpy.node import Node
from shared_control.contract import ANSWER_DIGITS, answer_label
from shared_control.world import World
from std_msgs.msg import Float64MultiArray

from . import contract
from .fast_loop import Polled
from .torque_command import command_layout
from .wire import read_message
from .wrenches import LARGEST

ANSWER_LATE_NS = 1_000_000_000
"""However long torques may be silent: answers to older joint states than this are not for this robot."""


class TorqueInput(Polled):
    """Joint torques on /effort_controller/commands; unusable ones are refused with an error.

    Args:
        node: the robot's node.
        dof: number of its joints.
        timeout: for how long torques may be silent where the robot runs freely, s. It gets its answers some ticks late;
            one that is later than this counts as none, as if it had not come yet.
    """

    def __init__(self, node: Node, dof: int, timeout: float):
        self._dof = dof
        self._late_ns = min(round(timeout * 1e9), ANSWER_LATE_NS)
        super().__init__(node, contract.EFFORT_COMMANDS, raw=True)
        self._layout = command_layout(dof)

    def read(self, data: bytes, stamp_ns: int | None = None, late_ns: int = 0) -> np.ndarray | None:
        """Torques of a serialized command, (n,), N m.

        Args:
            data: the command.
            stamp_ns: of the joint states that are to be answered; None: of any.
            late_ns: the answer may be to joint states so much older than that.

        Returns: None when it is unusable, or the answer to other joint states. One that does not say what it answers
            will do for any.
        """
        try:
            torque, label = self._parts(data)
        except ValueError as error:
            self._refuse(str(error))
            return None
        if not (torque.shape == (self._dof,) and math.isfinite(torque.sum())):
            self._refuse(f'expected {self._dof} finite torques, got {torque[:10].tolist()}')
            return None
        says_stamp = len(label) == ANSWER_DIGITS and label.isdigit()
        if stamp_ns is not None and says_stamp and not stamp_ns - late_ns <= int(label) <= stamp_ns:
            if late_ns:  # else the robot waits for its answer, and says so itself
                self._node.get_logger().warning(
                    f'torques on {self.topic_name} do not count: they answer joint states that are '
                    f'{(stamp_ns - int(label)) * 1e-9:.3f} s old, not those of the last {late_ns * 1e-9:g} s',
                    throttle_duration_sec=5.0)
            return None
        return torque

    def _parts(self, data: bytes) -> tuple[np.ndarray, bytes]:
        """The torques, whatever they are, and what the dimension is called.

        Raises:
            ValueError: it is no Float64MultiArray.
        """
        if self._layout.fits(data):
            return self._layout.views(data)[0], data[self._layout.text]
        message = read_message(data, Float64MultiArray)
        dimensions = message.layout.dim
        label = dimensions[0].label.encode() if dimensions else b''
        if len(label) == ANSWER_DIGITS:
            dimensions[0].label = answer_label(0)  # as the layout has it
            self._layout.learn(message, data)
        return np.array(message.data), label

    def _refuse(self, fault: str) -> None:
        self._node.get_logger().error(
            f'dropped a message on {self.topic_name}: {fault}', throttle_duration_sec=1.0)

    def take_torque(self, stamp_ns: int) -> np.ndarray | None:
        """The torques that wait for a robot that runs freely, (n,), N m, if they are of use to it.

        ``stamp_ns``: of its newest joint states.
        """
        message = self.take()
        return None if message is None else self.read(message, stamp_ns, self._late_ns)


class PushInput:
    """Pushes at the tray on /disturbance; each counts for a while.

    Args:
        node: the robot's node.
        world: what is pushed.
        ticks: how long a push counts.
    """

    def __init__(self, node: Node, world: World, ticks: int):
        self._node = node
        self._world = world
        self._ticks = ticks
        self._input = Polled(node, contract.DISTURBANCE)
        self._until = 0

    def update(self, tick: int) -> None:
        """Take a new push, or end the last one when its time is up."""
        message = self._input.take()
        if message is None:
            if self._until and tick >= self._until:
                self._world.push(np.zeros(3))
                self._until = 0
            return
        force = np.array([message.wrench.force.x, message.wrench.force.y, message.wrench.force.z])
        is_possible = (np.abs(force) <= LARGEST).all()  # nan is not
        if message.header.frame_id != self._world.spec.base_frame or not is_possible:
            self._node.get_logger().error(
                f'dropped a message on {self._input.topic_name}: frame_id {message.header.frame_id!r} (expected '
                f'{self._world.spec.base_frame!r}), force {force} (at most {LARGEST:.0f} N)', throttle_duration_sec=1.0)
            return
        self._world.push(force)
        self._until = tick + self._ticks
