"""A moment that counted, as the controller publishes it."""

import numpy as np
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from shared_control_ros.contract import Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import to_ns
from shared_control_ros.wrenches import moment_of


class AppliedMoment:
    """Follows one of the controller's moments in the order of its stamps.

    Args:
        node: the node that subscribes.
        topic: of the controller.
        axes: of the task.
    """

    def __init__(self, node: Node, topic: Topic, axes: tuple[int, ...]):
        self._axes = axes
        self._node = node
        self._input = Polled(node, topic, depth=topic.qos.depth)
        self.clear()

    def publisher_count(self) -> int:
        """How many publishers the topic has."""
        return self._input.publisher_count()

    def clear(self) -> None:
        """Forget everything, what waits included."""
        self._input.clear()
        self._next: WrenchStamped | None = None
        self._moment = np.zeros(len(self._axes))

    def before(self, stamp_ns: int) -> np.ndarray:
        """The newest moment stamped before ``stamp_ns``, (k,), N m. Stamps must not run backwards."""
        while (wrench := self._next or self._input.take()) is not None:
            if to_ns(wrench.header.stamp) >= stamp_ns:
                break
            self._next = None
            try:
                self._moment = moment_of(wrench, self._axes)
            except ValueError as error:
                self._node.get_logger().error(
                    f'dropped a message on {self._input.topic_name}: {error}', throttle_duration_sec=1.0)
        self._next = wrench
        return self._moment
