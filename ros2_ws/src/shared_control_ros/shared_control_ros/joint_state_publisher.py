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

"""What every robot publishes of its joints."""

import numpy as np
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from shared_control.robot.spec import RobotSpec

from . import contract
from .serialized import set_stamp
from .wire import WireLayout

THROTTLED_PERIOD_NS = 10_000_000
"""Throttled joint states, the ball's odometry and the clock go out at 100 Hz, with stamps that are multiples of this:
who needs joints and ball of one moment finds them by their stamps."""


class JointStatePublisher:
    """Publishes /joint_states, and those of every 10 ms as /joint_states_throttle, too.

    The bytes of the message are made once and filled in again and again.
    """

    def __init__(self, node: Node, spec: RobotSpec) -> None:
        zeros = [0.0] * spec.dof
        message = JointState(name=list(spec.joints), position=zeros, velocity=zeros, effort=zeros)
        message.header.frame_id = spec.base_frame
        self._data = bytearray(serialize_message(message))
        self._position, self._velocity, self._effort = WireLayout(
            message, ('position', 'velocity', 'effort')).views(self._data)
        self._publisher = node.create_publisher(
            contract.JOINT_STATES.msg_type, contract.JOINT_STATES.name, contract.JOINT_STATES.qos)
        self._throttled_publisher = node.create_publisher(
            contract.JOINT_STATES_THROTTLE.msg_type, contract.JOINT_STATES_THROTTLE.name,
            contract.JOINT_STATES_THROTTLE.qos)
        self._stamp_ns: int | None = None

    def publish(self, stamp_ns: int, position: np.ndarray, velocity: np.ndarray, effort: np.ndarray) -> None:
        """Publish positions (rad), velocities (rad/s) and the torques that were commanded last (N m), each (n,)."""
        set_stamp(self._data, stamp_ns)
        self._position[:] = position
        self._velocity[:] = velocity
        self._effort[:] = effort
        self._publisher.publish(bytes(self._data))
        late_ns = stamp_ns % THROTTLED_PERIOD_NS
        due_ns, last_ns, self._stamp_ns = stamp_ns - late_ns, self._stamp_ns, stamp_ns
        if late_ns == 0 or (last_ns is not None and last_ns < due_ns):
            # A busy machine does not see every state of a robot. From the next one it is at the most 9 ms back to where
            # the joints were when it was due.
            set_stamp(self._data, due_ns)
            self._position -= self._velocity * (late_ns * 1e-9)
            self._throttled_publisher.publish(bytes(self._data))

    def flush(self) -> None:
        """Wait a moment until everybody has what was sent: a recorder may lag behind."""
        self._publisher.wait_for_all_acked(Duration(seconds=1))
