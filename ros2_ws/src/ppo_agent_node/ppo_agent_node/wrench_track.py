"""What one source asked for, and when."""

import math

from rclpy.node import Node
from rclpy.serialization import deserialize_message
from shared_control_ros.contract import BASE_FRAME, Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.serialized import stamp_of


class WrenchTrack:
    """Follows a wrench topic in the order of its stamps.

    Args:
        node: the node that listens.
        topic: the topic.
        timeout: age from which on a moment counts as zero, s; never, when None.
    """

    def __init__(self, node: Node, topic: Topic, timeout: float | None = None):
        self._input = Polled(node, topic, depth=topic.qos.depth, raw=True)
        self._type = topic.msg_type
        self._timeout_ns = math.inf if timeout is None else timeout * 1e9
        self.clear()

    def publisher_count(self) -> int:
        """How many publishers the topic has."""
        return self._input.publisher_count()

    def clear(self) -> None:
        """Forget everything, what waits included."""
        self._input.clear()
        self._next: bytes | None = None
        self._m_y = 0.0
        self._stamp_ns = 0

    def at(self, stamp_ns: int) -> float:
        """The newest moment stamped ``stamp_ns`` or earlier, N m. Stamps must not run backwards."""
        newest = None
        while (serialized := self._next or self._input.take()) is not None:
            if stamp_of(serialized) > stamp_ns:
                break
            newest, self._next = serialized, None
        self._next = serialized
        if newest is not None:
            message = deserialize_message(newest, self._type)
            if message.header.frame_id == BASE_FRAME and math.isfinite(message.wrench.torque.y):
                self._m_y = message.wrench.torque.y
                self._stamp_ns = stamp_of(newest)
        return self._m_y if stamp_ns - self._stamp_ns <= self._timeout_ns else 0.0
