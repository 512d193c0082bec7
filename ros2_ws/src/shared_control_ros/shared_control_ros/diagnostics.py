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

"""Once a second: how fast a node runs and what is wrong with what it hears."""

import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from . import contract
from .fast_loop import Polled, follow_clock, warn_of_unheard

PATIENCE = 10.0
"""The topic that a node cannot do without may have no publisher for so long, s: nodes start, and start anew."""


class Diagnostics:
    """Collects the periods of a loop and publishes them at 1 Hz on ``/diagnostics``.

    Args:
        node: the node that publishes.
        period: the loop's nominal period, s. A period of more than 1.5 times that is an overrun.
        needs: the topic that the node cannot do without: that it has no publisher is a problem.
    """

    _CAPACITY = 4096

    def __init__(self, node: Node, period: float, needs: Polled | None = None):
        self._node = node
        self._needs = needs
        self._had_publisher = time.monotonic()
        self._nominal = period
        self._publisher = node.create_publisher(
            contract.DIAGNOSTICS.msg_type, contract.DIAGNOSTICS.name, contract.DIAGNOSTICS.qos)
        self._periods = np.empty(self._CAPACITY)
        self._count = 0
        self._last: float | None = None
        self._next_report = time.monotonic() + 1.0
        self.overruns = 0

    def tick(self) -> None:
        """Call once a period."""
        now = time.monotonic()
        if self._last is not None:
            elapsed = now - self._last
            self._periods[self._count % self._CAPACITY] = elapsed
            self._count += 1
            if elapsed > 1.5 * self._nominal:
                self.overruns += 1
        self._last = now

    def skip(self) -> None:
        """The loop stood still on purpose (a pause): do not count the time since the last tick."""
        self._last = None

    def due(self) -> bool:
        """Whether a second has passed since the last report."""
        return time.monotonic() >= self._next_report

    def publish(self, problems: dict[str, str], level: bytes | None = None, **values: object) -> None:
        """Publish the statistics, ``values``, and ``problems`` (topic -> what is wrong with it).

        ``level`` is that of :class:`DiagnosticStatus`; OK, or WARN when there are problems, when not given.
        """
        self._next_report = time.monotonic() + 1.0
        periods = self._periods[:min(self._count, self._CAPACITY)] * 1e3
        self._count = 0
        p50, p99 = np.percentile(periods, [50, 99]) if periods.size else (float('nan'), float('nan'))
        status = DiagnosticStatus(name=self._node.get_fully_qualified_name(), hardware_id='')
        problems = {**problems, **self._missing()}
        status.level = level or (DiagnosticStatus.WARN if problems else DiagnosticStatus.OK)
        status.message = '; '.join(f'{topic}: {what}' for topic, what in problems.items()) or 'ok'
        shown = {'period_p50_ms': f'{p50:.3f}', 'period_p99_ms': f'{p99:.3f}', 'overruns': self.overruns, **values}
        status.values = [KeyValue(key=key, value=str(value)) for key, value in shown.items()]
        message = DiagnosticArray(status=[status])
        follow_clock(self._node)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)
        warn_of_unheard(self._node)

    def _missing(self) -> dict[str, str]:
        if self._needs is None:
            return {}
        now = time.monotonic()
        if self._needs.publisher_count():
            self._had_publisher = now
        if now - self._had_publisher < PATIENCE:
            return {}
        problem = (f'has had no publisher for {now - self._had_publisher:.0f} s: does its node run, with the same '
                   'ROS_DOMAIN_ID? If on another machine: start this node again, since a node sees only the networks '
                   'that were up when it started')
        self._node.get_logger().warning(f'{self._needs.topic_name} {problem}', throttle_duration_sec=30.0)
        return {self._needs.topic_name: problem}
