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

"""A gamepad or the like, as its driver publishes it on /joy: says on /human/keys what its axes and buttons mean."""

import time
from collections import deque

from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control.keys import Key, has_let_go
from shared_control.sticks import DEAD_BAND, JoyMapping
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.parameters import ParameterError, declare

from .shared_names import SharedNames, words_of_shared
from .sources import REMEMBERED

NAME = 'joy'
"""The source that a driver is taken for which gives no name, or the name of a source of ours."""


class Joystick:
    """Passes on what drivers of ``sensor_msgs/Joy`` publish, as sources of keys and sticks.

    Args:
        node: the node that hears and publishes.
        reserved: names of sources that no driver may have.
        as_it_is: pass states on as they are, for a device of somebody else.

    Raises:
        ParameterError: a parameter cannot be used.
    """

    def __init__(self, node: Node, reserved: tuple[str, ...], as_it_is: bool):
        self._node, self._reserved = node, reserved
        buttons = declare(node, 'joy_buttons', list(range(len(Key))),
                          'Buttons of /joy (from 0) that are left, right, space, up, down; -1: there is none.')
        axes = declare(node, 'joy_axes', [0, 1], 'Axes of /joy (from 0) that are left-right and up-down; -1: there is '
                                                 'none.')
        scale = declare(node, 'joy_scale', [1.0, 1.0], 'What these axes are multiplied with; positive is left, and up.')
        rest = declare(node, 'joy_rest', [0.0, 0.0], 'What these axes read when nobody touches them.')
        try:
            self._mapping = None if as_it_is else JoyMapping(buttons, axes, scale, rest)
        except ValueError as error:
            raise ParameterError(f'parameter joy_{error}') from error
        self._names = SharedNames()
        self._heard = Polled(node, contract.JOY, depth=50)
        self._publisher = node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
        self._known: deque[str] = deque(maxlen=REMEMBERED)

    def poll(self) -> None:
        """Pass on what has come."""
        while (taken := self._heard.take_with_info()) is not None:
            joy, info = taken
            if joy.header.frame_id in (*self._reserved, ''):
                joy.header.frame_id = NAME
            if self._names.is_shared(joy.header.frame_id, info['publication_sequence_number'], time.monotonic()):
                self._node.get_logger().error(
                    words_of_shared(joy.header.frame_id, self._heard.topic_name), throttle_duration_sec=1.0)
                continue
            if joy.header.frame_id not in self._known:
                self._known.append(joy.header.frame_id)
                self._node.get_logger().info(
                    f'{joy.header.frame_id!r} on {self._heard.topic_name}: {len(joy.axes)} axes, {len(joy.buttons)} '
                    'buttons; joy_axes and joy_buttons say which of them count')
            if self._mapping is None or has_let_go(joy.axes, joy.buttons):
                self._publisher.publish(joy)
                continue
            try:
                state = Joy(
                    header=joy.header, axes=self._mapping.axes(joy.axes), buttons=self._mapping.buttons(joy.buttons))
            except ValueError as error:
                self._node.get_logger().error(
                    f'dropped a message of {joy.header.frame_id!r} on {self._heard.topic_name}: {error}',
                    throttle_duration_sec=1.0)
                continue
            self._publisher.publish(state)


def declare_stick(node: Node) -> tuple[float, float]:
    """Declare how sticks are felt: the dead band, as part of their travel, and the exponent of what lies beyond."""
    return (declare(node, 'dead_band', DEAD_BAND, 'Part of the travel of a stick, around its middle, that is nothing.',
                    minimum=0.0, maximum=0.9),
            declare(node, 'curve', 1.0, 'Exponent of what lies beyond; above 1 makes small moments finer.',
                    minimum=0.2, maximum=5.0))
