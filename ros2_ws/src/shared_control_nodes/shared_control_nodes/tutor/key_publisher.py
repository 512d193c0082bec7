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

"""Key presses as a source of keys publishes them."""

import time

from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control.keys import BUTTONS, TUTOR, Key, KeyMap
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns

HELD_SECONDS = 0.06
"""How long a press lasts, s."""
REPEAT_SECONDS = 0.05
"""The state of the keys is repeated when nothing happened for so long, s."""


class KeyPublisher:
    """Presses and releases keys on ``/human/keys`` and repeats their state.

    Stamps are the robot's time; 0, before that is known, becomes the node's.

    Args:
        node: whose publisher it is.
        keys: those of the task.
    """

    def __init__(self, node: Node, keys: KeyMap):
        self._publisher = node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
        self._up = [0] * max(BUTTONS, *(key + 1 for key in keys))
        self._joy = Joy(buttons=self._up)
        self._joy.header.frame_id = TUTOR
        self._published_at = 0.0
        self._clock = node.get_clock()
        self.presses = 0

    def press(self, key: Key, stamp_ns: int) -> None:
        """A key goes down."""
        self.presses += 1
        self._joy.buttons = [int(button == key) for button in range(len(self._up))]
        self._publish(stamp_ns)

    def update(self, stamp_ns: int) -> None:
        """Release the key, or repeat the state, when it is time to."""
        age = time.monotonic() - self._published_at
        if any(self._joy.buttons):
            if age >= HELD_SECONDS:
                self.release(stamp_ns)
        elif age >= REPEAT_SECONDS:
            self._publish(stamp_ns)

    def release(self, stamp_ns: int) -> None:
        """All keys are up."""
        self._joy.buttons = self._up
        self._publish(stamp_ns)

    def _publish(self, stamp_ns: int) -> None:
        stamp_ns = stamp_ns or self._clock.now().nanoseconds
        if not stamp_ns:
            return  # simulation time is not known yet
        set_ns(self._joy.header.stamp, stamp_ns)
        self._publisher.publish(self._joy)
        self._published_at = time.monotonic()
