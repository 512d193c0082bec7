"""What one source asked for, and when."""

import math

from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node

from shared_control_ros.contract import BASE_FRAME, Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import to_ns


class WrenchTrack:
    """Follows a wrench topic in the order of its stamps.

    Args:
        node: the node that listens.
        topic: the topic.
        timeout: age from which on a moment counts as zero, s; never, when None.
    """

    def __init__(self, node: Node, topic: Topic, timeout: float | None = None):
        self._input = Polled(node, topic, depth=topic.qos.depth)
        self._timeout_ns = math.inf if timeout is None else timeout * 1e9
        self.clear()

    def publisher_count(self) -> int:
        """How many publishers the topic has."""
        return self._input.publisher_count()

    def clear(self) -> None:
        """Forget everything, what waits included."""
        self._input.clear()
        self._next: WrenchStamped | None = None
        self._m_y = 0.0
        self._stamp_ns = 0

    def at(self, stamp_ns: int) -> float:
        """The newest moment stamped ``stamp_ns`` or earlier, N m. Stamps must not run backwards."""
        while (message := self._next or self._input.take()) is not None:
            self._next = message if to_ns(message.header.stamp) > stamp_ns else None
            if self._next is not None:
                break
            if message.header.frame_id == BASE_FRAME and math.isfinite(message.wrench.torque.y):
                self._m_y = message.wrench.torque.y
                self._stamp_ns = to_ns(message.header.stamp)
        return self._m_y if stamp_ns - self._stamp_ns <= self._timeout_ns else 0.0
