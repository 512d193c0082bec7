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

"""The ball out of ``/ball``."""

from nav_msgs.msg import Odometry
from shared_control.scene import BALL_WITHIN

from .contract import BASE_FRAME

Vector = tuple[float, float, float]


def ball_state(message: Odometry, frame: str = BASE_FRAME) -> tuple[Vector, Vector]:
    """Position, m, and velocity, m/s, of the ball in the base's ``frame``.

    Raises:
        ValueError: they are given in another frame, or a component is not finite or beyond ``BALL_WITHIN``; the message
            says which.
    """
    if message.header.frame_id != frame:
        raise ValueError(f'frame_id is {message.header.frame_id!r}, expected {frame!r}')
    position, velocity = message.pose.pose.position, message.twist.twist.linear
    state = (position.x, position.y, position.z), (velocity.x, velocity.y, velocity.z)
    for what, vector in zip(('position', 'velocity'), state, strict=True):
        for axis, value in zip('xyz', vector, strict=True):
            if not abs(value) <= BALL_WITHIN:  # nor NaN
                raise ValueError(f'{what}.{axis} is {value:g}, which no ball has: at most {BALL_WITHIN:g} are possible')
    return state
