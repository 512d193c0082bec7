"""The moment that one source (human or agent) asks for, as the controller takes it."""

import math
import time

import numpy as np
from rclpy.node import Node
from shared_control.control.moments import MomentSource
from shared_control_ros.contract import BASE_FRAME, Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import to_ns


class WrenchInput:
    """Takes the newest wrench of a topic and refuses what cannot be trusted.

    Args:
        node: the node that listens.
        topic: where the source publishes.
        timeout: age after which a wrench is stale, s.
    """

    def __init__(self, node: Node, topic: Topic, timeout: float):
        self._node = node
        self._input = Polled(node, topic)
        self._timeout = timeout
        self._source = MomentSource(1)
        self.topic_name = self._input.topic_name

    def update(self, now_ns: int) -> None:
        """Take the newest message, if there is one. ``now_ns`` is the robot's time."""
        message = self._input.take()
        if message is None:
            return
        m_y = message.wrench.torque.y
        stamp_ns = to_ns(message.header.stamp)
        fault = self._fault(message.header.frame_id, m_y, (now_ns - stamp_ns) * 1e-9)
        if fault:
            self._node.get_logger().error(
                f'dropped a message on {self.topic_name}: {fault}', throttle_duration_sec=1.0)
            return
        self._source.moment = np.array([m_y])
        self._source.stamp_ns = stamp_ns

    def _fault(self, frame: str, m_y: float, age: float) -> str:
        if frame != BASE_FRAME:
            return f'frame_id is {frame!r}, expected {BASE_FRAME!r}'
        if not math.isfinite(m_y):
            return f'torque.y is {m_y}'
        if age > self._timeout:
            return f'its stamp is {age:.3f} s old, more than command_timeout ({self._timeout} s)'
        if age < -self._timeout:
            return f'its stamp is {-age:.3f} s ahead of /joint_states: do both use the same clock (use_sim_time)?'
        return ''

    def moment(self, now_ns: int) -> np.ndarray:
        """The moment that counts at ``now_ns``, (1,), N m."""
        return self._source.at(now_ns, self._timeout)

    def problem(self, now_ns: int) -> str:
        """What is wrong with this source, for the diagnostics; empty when nothing is."""
        if not self._source.stamp_ns:
            return 'nothing received yet'
        if not self._source.is_stale(now_ns, self._timeout):
            return ''
        return f'silent for {(now_ns - self._source.stamp_ns) * 1e-9:.2f} s'

    def wait_for_stamp(self, stamp_ns: int, timeout: float) -> bool:
        """Wait up to ``timeout`` s for a wrench as new as ``stamp_ns``; say whether one came."""
        deadline = time.monotonic() + timeout
        while self._source.stamp_ns < stamp_ns:
            if time.monotonic() > deadline:
                return False
            self._input.wait_ready(0.01)
            self.update(stamp_ns)
        return True
