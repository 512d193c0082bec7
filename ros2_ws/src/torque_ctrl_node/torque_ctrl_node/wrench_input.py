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

"""The moment that one source (human or agent) asks for, as the controller takes it."""

import time

import numpy as np
from rclpy.node import Node
from shared_control.control.moments import MomentSource
from shared_control_ros.contract import Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import to_ns
from shared_control_ros.wrenches import moment_of, not_shared


class WrenchInput:
    """Takes the newest wrench of a topic and refuses what cannot be trusted.

    Args:
        node: the node that listens.
        topic: where the source publishes.
        axes: of the task.
        timeout: age after which a wrench is stale, s.
        frame: name of the base frame.
    """

    def __init__(self, node: Node, topic: Topic, axes: tuple[int, ...], timeout: float, frame: str):
        self._node = node
        self._input = Polled(node, topic)
        self._timeout = timeout
        self._axes, self._frame = axes, frame
        self._source = MomentSource(len(axes), timeout)
        self.topic_name = self._input.topic_name

    def update(self, now_ns: int) -> None:
        """Take the newest message, if there is one. ``now_ns`` is the robot's time."""
        self._source.follow(now_ns)
        message = self._input.take()
        if message is None:
            return
        try:
            moment, stamp_ns = moment_of(message, self._axes, self._frame), to_ns(message.header.stamp)
            self._check_age((now_ns - stamp_ns) * 1e-9)
        except ValueError as error:
            self._node.get_logger().error(
                f'dropped a message on {self.topic_name}: {error}', throttle_duration_sec=1.0)
            return
        self._source.take(moment, stamp_ns)
        if lost := not_shared(message, self._axes):  # a source with another task, started by hand
            self._node.get_logger().warning(
                f'{self.topic_name}: {lost} (parameter task; has its source the same?)', throttle_duration_sec=5.0)

    def _check_age(self, age: float) -> None:
        if age > self._timeout:
            raise ValueError(f'its stamp is {age:.3f} s old, more than command_timeout ({self._timeout} s)')
        if age < -self._timeout:
            raise ValueError(
                f'its stamp is {-age:.3f} s ahead of /joint_states: do both use the same clock (use_sim_time)?')

    def moment(self, now_ns: int) -> np.ndarray:
        """The moment that counts at ``now_ns``, (k,), N m."""
        return self._source.at(now_ns)

    def problem(self, now_ns: int) -> str:
        """What is wrong with this source, for the diagnostics; empty when nothing is."""
        if not self._source.stamp_ns:
            return "nothing received since the robot's time began"
        age = self._source.age(now_ns)
        return f'silent for {age:.2f} s' if age > self._timeout else ''

    def wait_for_stamp(self, stamp_ns: int, timeout: float) -> bool:
        """Wait up to ``timeout`` s for a wrench as new as ``stamp_ns``; whether one came."""
        deadline = time.monotonic() + timeout
        self._source.follow(stamp_ns)
        while not -self._timeout <= self._source.age(stamp_ns) <= 0.0:
            if time.monotonic() > deadline:
                return False
            self._input.wait_ready(0.01)
            self.update(stamp_ns)
        return True
