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

"""A moment that counted, as the controller publishes it."""

import numpy as np
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from shared_control_ros.contract import Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import to_ns
from shared_control_ros.wrenches import moment_of

SILENT_NS = 120_000_000
"""The controller repeats its moments every ten ticks; one that is older than this at a policy tick counts no more."""
AHEAD_NS = 1_000_000_000
"""What waits may have been sent since the policy tick was taken up, but not this long after it."""


class AppliedMoment:
    """Follows one of the controller's moments in the order of its stamps.

    Args:
        node: the node that subscribes.
        topic: of the controller.
        axes: of the task.
        frame: name of the base frame.
    """

    def __init__(self, node: Node, topic: Topic, axes: tuple[int, ...], frame: str):
        self._axes, self._frame = axes, frame
        self._node = node
        self._input = Polled(node, topic, depth=topic.qos.depth)
        self.clear()

    @property
    def topic_name(self) -> str:
        """The name after namespace and remapping."""
        return self._input.topic_name

    @property
    def newest_ns(self) -> int:
        """The stamp of what :meth:`before` has found, ns; 0 when nothing has come."""
        return self._stamp_ns

    def publisher_count(self) -> int:
        """How many publishers the topic has."""
        return self._input.publisher_count()

    def clear(self) -> None:
        """Forget everything, what waits included."""
        self._input.clear()
        self._next: WrenchStamped | None = None
        self._moment, self._stamp_ns = np.zeros(len(self._axes)), 0

    def before(self, stamp_ns: int) -> np.ndarray:
        """The newest moment stamped before ``stamp_ns``, (k,), N m; zero when the controller has fallen silent.

        Stamps must not run backwards.
        """
        while (wrench := self._next or self._input.take()) is not None:
            self._next = None
            try:
                moment, sent_ns = moment_of(wrench, self._axes, self._frame), to_ns(wrench.header.stamp)
                if sent_ns > stamp_ns + AHEAD_NS:
                    raise ValueError(f'its stamp is {(sent_ns - stamp_ns) * 1e-9:.3f} s ahead of /ball')
            except ValueError as error:
                self._node.get_logger().error(
                    f'dropped a message on {self._input.topic_name}: {error}', throttle_duration_sec=1.0)
                continue
            if sent_ns >= stamp_ns:
                self._next = wrench
                break
            self._moment, self._stamp_ns = moment, sent_ns
        if stamp_ns - self._stamp_ns > SILENT_NS:
            return np.zeros(len(self._axes))
        return self._moment

    def has_come(self) -> bool:
        """Whether another one has come since :meth:`before`."""
        self._next = self._next or self._input.take()
        return self._next is not None
