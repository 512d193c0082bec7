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

"""What viewers need: robot_description, transforms of arm and ball, markers of tray, ball and moments.

Takes /ball, /joint_states_throttle and the three wrenches; publishes /robot_description, /tf and /markers. Beside
robot_state_publisher set ``arm`` to false: it then leaves description and arm to that node.
"""

from contextlib import suppress

import numpy as np
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.publisher import Publisher
from shared_control.control.moments import MomentSource
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying
from shared_control.scene import Ball
from shared_control_ros import contract
from shared_control_ros.ball_states import ball_state
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.joints import joint_positions
from shared_control_ros.parameters import declare
from shared_control_ros.runner import Stop, run
from shared_control_ros.stamps import to_ns
from shared_control_ros.task_parameter import declare_task
from shared_control_ros.wrenches import moment_of
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

from .markers import ball_marker, moment_markers, tray_markers
from .transforms import arm_transforms, ball_transform

try:
    from tf2_msgs.msg import TFMessage
except ImportError:  # ROS from PyPI has no tf2
    TFMessage = None

ROBOT_DESCRIPTION = contract.Topic('robot_description', String, contract.qos_latched(1))
MARKERS = contract.Topic('markers', MarkerArray, contract.qos(10))
WRENCHES = {'human': contract.HUMAN_WRENCH, 'agent': contract.AGENT_WRENCH, 'applied': contract.APPLIED_WRENCH}
STALE_AFTER = 0.1
"""A moment that is not repeated is shown as zero after this, s."""


class RobotViewNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('robot_view_node')
        self._with_arm = declare(
            node, 'arm', True, 'Publish robot_description and the transforms of the arm: false beside '
            'robot_state_publisher, which does that.')
        self._radius = declare(
            node, 'ball_radius', Ball.radius, 'Radius of the ball, as in panda_sim_node.', unit='m',
            minimum=0.005, maximum=0.05)
        task = declare_task(node, 'What is taught: the tray, and the axes of the moments.')
        self._axes = task.axes
        self._model = RobotModel(carrying(panda(), task.scene))
        self._boxes = task.scene.boxes
        self._balls = Polled(node, contract.BALL)
        self._joints = Polled(node, contract.JOINT_STATES_THROTTLE)
        self._wrenches = {source: (Polled(node, topic), MomentSource(len(task.axes), STALE_AFTER))
                          for source, topic in WRENCHES.items()}
        self._markers = node.create_publisher(MARKERS.msg_type, MARKERS.name, MARKERS.qos)
        self._tf = self._tf_publisher()
        if self._with_arm:
            self._description = node.create_publisher(
                ROBOT_DESCRIPTION.msg_type, ROBOT_DESCRIPTION.name, ROBOT_DESCRIPTION.qos)
            self._description.publish(String(data=self._model.spec.description))
        self._background = Background(node)
        self._diagnostics = Diagnostics(node, POLICY_PERIOD, needs=self._balls)

    def _tf_publisher(self) -> Publisher | None:
        if TFMessage is None:
            self.node.get_logger().warning(
                'tf2_msgs is not installed (PyPI has none; apt-get install ros-jazzy-tf2-msgs): markers, but no /tf')
            return None
        return self.node.create_publisher(TFMessage, '/tf', contract.qos(100))

    def run(self, stop: Stop) -> None:
        """Show every state that a viewer can, until told to stop."""
        period_ns = round(POLICY_PERIOD * 1e9)
        while not stop.requested:
            ball = self._balls.wait(0.05)
            if ball is None:
                self._diagnostics.skip()
            elif to_ns(ball.header.stamp) % period_ns == 0:
                self._diagnostics.tick()
                self._show(ball)
            self._background.poll()
            if self._diagnostics.due():
                self._diagnostics.publish({})

    def _show(self, ball: Odometry) -> None:
        joints = self._joints.take()
        if joints is None:
            return
        source = self._joints
        try:
            q = joint_positions(joints, self._model.spec)
            source = self._balls
            ball_state(ball, self._model.spec.base_frame)
        except ValueError as error:
            self.node.get_logger().error(
                f'dropped a message on {source.topic_name}: {error}', throttle_duration_sec=1.0)
            return
        if self._tf is not None:
            self._tf.publish(TFMessage(transforms=self._transforms(ball, q)))
        self._markers.publish(MarkerArray(markers=self._all_markers(ball, q)))

    def _transforms(self, ball: Odometry, q: np.ndarray) -> list[TransformStamped]:
        transforms = [ball_transform(ball)]
        if self._with_arm:
            transforms += arm_transforms(self._model, q, ball.header.stamp)
        return transforms

    def _all_markers(self, ball: Odometry, q: np.ndarray) -> list[Marker]:
        tray, rotation = self._model.tray_pose(q)
        position = ball.pose.pose.position
        markers = tray_markers(tray, rotation, self._boxes)
        markers.append(ball_marker(np.array([position.x, position.y, position.z]), self._radius))
        for source in WRENCHES:
            markers += moment_markers(source, self._moment(source, to_ns(ball.header.stamp)), self._axes, tray)
        for marker in markers:
            marker.header.stamp = ball.header.stamp
        return markers

    def _moment(self, source: str, now_ns: int) -> np.ndarray:
        """What a source asks for at the moment, (k,), N m."""
        wrenches, moment = self._wrenches[source]
        moment.follow(now_ns)
        message = wrenches.take()
        if message is not None:
            with suppress(ValueError):
                moment.take(moment_of(message, self._axes), to_ns(message.header.stamp))
        return moment.at(now_ns)

    def close(self) -> None:
        """Nothing to leave behind."""
        self._background.close()


def main() -> int:
    """Entry point."""
    return run(RobotViewNode)


if __name__ == '__main__':
    raise SystemExit(main())
