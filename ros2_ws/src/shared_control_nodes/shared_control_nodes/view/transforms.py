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

"""Poses as transforms between frames."""

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from shared_control.robot.model import RobotModel


def arm_transforms(model: RobotModel, q: np.ndarray, stamp: Time) -> list[TransformStamped]:
    """Every link in the frame of the link before it, as robot_state_publisher gives them."""
    transforms = []
    for parent, child, position, quaternion in model.link_transforms(q):
        transform = TransformStamped(child_frame_id=child)
        transform.header.stamp = stamp
        transform.header.frame_id = parent
        to, turn = transform.transform.translation, transform.transform.rotation
        to.x, to.y, to.z = position.tolist()
        turn.x, turn.y, turn.z, turn.w = quaternion.tolist()
        transforms.append(transform)
    return transforms


def ball_transform(ball: Odometry) -> TransformStamped:
    """The ball's frame in the frame of its odometry."""
    transform = TransformStamped(header=ball.header, child_frame_id=ball.child_frame_id)
    position, to = ball.pose.pose.position, transform.transform.translation
    to.x, to.y, to.z = position.x, position.y, position.z
    transform.transform.rotation = ball.pose.pose.orientation
    return transform
