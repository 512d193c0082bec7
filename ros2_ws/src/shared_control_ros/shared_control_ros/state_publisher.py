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

"""What a robot in a simulated world publishes: joints, ball, clock."""

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from shared_control.world import World

from . import contract
from .joint_state_publisher import THROTTLED_PERIOD_NS, JointStatePublisher
from .stamps import set_ns


class StatePublisher:
    """Publishes a world's state; the messages are made once and filled in again and again.

    Args:
        node: the robot's node.
        world: the world.
        with_clock: publish /clock, too: its time is everybody's.
    """

    def __init__(self, node: Node, world: World, with_clock: bool = True):
        self._world = world
        self._joints = JointStatePublisher(node, world.spec)
        # The ball's frame sits at its centre with the axes of the base: which way a ball has turned is of no use,
        # and so the twist, which belongs to this frame, has the base's axes.
        self._ball = Odometry(child_frame_id=contract.BALL_FRAME)
        self._ball.header.frame_id = world.spec.base_frame
        self._publish_ball = node.create_publisher(
            contract.BALL.msg_type, contract.BALL.name, contract.BALL.qos).publish
        self._clock = Clock() if with_clock else None
        if with_clock:
            self._publish_clock = node.create_publisher(
                contract.CLOCK.msg_type, contract.CLOCK.name, contract.CLOCK.qos).publish

    def publish(self, stamp_ns: int, effort: np.ndarray) -> None:
        """The state at a tick, with the torque commanded last ((n,), N m): joints at each, the rest every 10 ms."""
        with_ball = stamp_ns % THROTTLED_PERIOD_NS == 0
        if with_ball and self._clock is not None:
            set_ns(self._clock.clock, stamp_ns)
            self._publish_clock(self._clock)
        position, velocity = self._world.joint_state()
        self._joints.publish(stamp_ns, position, velocity, effort)
        if with_ball:
            self._fill_ball(stamp_ns)
            self._publish_ball(self._ball)

    def _fill_ball(self, stamp_ns: int) -> None:
        position, _, velocity, spin = self._world.ball_state()
        set_ns(self._ball.header.stamp, stamp_ns)
        pose, twist = self._ball.pose.pose, self._ball.twist.twist
        pose.position.x, pose.position.y, pose.position.z = position
        twist.linear.x, twist.linear.y, twist.linear.z = velocity
        twist.angular.x, twist.angular.y, twist.angular.z = spin

    def flush(self) -> None:
        """Wait a moment until everybody has what was sent: a recorder may lag behind."""
        self._joints.flush()
