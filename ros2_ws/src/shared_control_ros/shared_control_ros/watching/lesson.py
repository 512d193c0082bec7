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

"""What the agent tells of the lesson that decides whether keys count."""

from rclpy.node import Node
from shared_control.keys import COUNT_IN

from .. import contract
from ..fast_loop import Polled


class Lesson:
    """Phase and episode, from /training/phase and /training/episode."""

    def __init__(self, node: Node):
        self._log = node.get_logger()
        self._phases = Polled(node, contract.PHASE, qos_profile=contract.qos_latched())
        self._episodes = Polled(node, contract.EPISODE, qos_profile=contract.qos_latched())
        self.phase: str | None = None
        """None: nobody teaches a robot."""
        self.episode: int | None = None
        self.began_ns = 0
        """When the agent published the newest of both, ns of its clock of the day."""
        self.restarts = 0
        """How often the count of episodes has begun anew."""

    @property
    def keys_count(self) -> bool:
        """Keys count in practice, while the robot is taught, and when no lesson is given at all."""
        return self.phase in (None, *COUNT_IN)

    def update(self) -> bool:
        """Take what was published; whether a new episode or phase has begun."""
        before = self.phase, self.episode
        published_ns: list[int] = []
        while (taken := self._phases.take_with_info()) is not None:
            self.phase = taken[0].data
            published_ns.append(taken[1]['source_timestamp'])
        while (taken := self._episodes.take_with_info()) is not None:
            message, info = taken
            if message.data < 0:
                self._log.error(
                    f'dropped a message on {self._episodes.topic_name}: there is no episode {message.data}',
                    throttle_duration_sec=1.0)
                continue
            if self.episode is not None and message.data < self.episode:
                self.restarts += 1
            self.episode = message.data
            published_ns.append(info['source_timestamp'])
        self.began_ns = max(published_ns, default=self.began_ns)
        return (self.phase, self.episode) != before

    def forget_if_over(self) -> bool:
        """Forget the phase when the agent is gone; whether that was so. Call now and then, not at every tick."""
        if self.phase is None or self._phases.publisher_count() > 0:
            return False
        self.phase = None
        return True
