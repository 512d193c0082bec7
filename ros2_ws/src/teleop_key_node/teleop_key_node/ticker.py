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

"""A loop of some 50 Hz that keeps to the node's clock and costs next to nothing."""

import time
from typing import cast

from rclpy.clock import ROSClock
from rclpy.node import Node
from rclpy.time import Time
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import robot_time, to_ns


class Ticker:
    """Wakes a loop once a period of the node's clock.

    With ``use_sim_time`` the clock is taken from /clock by hand (an executor needs ten times the CPU), and ticks come
    at the multiples of the period, as soon as /clock shows them. While it stands still, ticks go on with its last
    time, so that keys and screen live.

    Args:
        period: s
    """

    def __init__(self, node: Node, period: float):
        self._period = period
        self._period_ns = round(period * 1e9)
        self._log = node.get_logger()
        self._ros_clock = cast(ROSClock, node.get_clock())
        self.clock = Polled(node, contract.CLOCK) if node.get_parameter('use_sim_time').value else None
        """Where the time comes from; None: from this machine."""
        self._now_ns = 0
        self._next = time.monotonic() + period

    def wait(self) -> int:
        """The node's time at the next tick, ns; 0 until /clock has shown it."""
        if self.clock is None:
            self._sleep()
            return self._ros_clock.now().nanoseconds
        deadline = time.monotonic() + 1.5 * self._period
        while (left := deadline - time.monotonic()) > 0:
            message = self.clock.wait(left)
            if message is None:
                continue
            try:
                now_ns = robot_time(to_ns(message.clock))
            except ValueError as error:
                self._log.error(f'dropped a message on {self.clock.topic_name}: {error}', throttle_duration_sec=1.0)
                continue
            before, self._now_ns = self._now_ns, now_ns
            self._ros_clock.set_ros_time_override(Time.from_msg(message.clock))
            if before // self._period_ns != self._now_ns // self._period_ns:
                break
        return self._now_ns

    def _sleep(self) -> None:
        now = time.monotonic()
        time.sleep(max(self._next - now, 0.0))
        self._next = max(self._next, now - self._period) + self._period
