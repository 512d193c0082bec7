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

"""What the agent tells of the training, under ``/training/``."""

from typing import Any

from diagnostic_msgs.msg import KeyValue
from rclpy.duration import Duration
from rclpy.node import Node
from shared_control.verdict import Verdict, episode_key
from shared_control_ros import contract
from shared_control_ros.contract import Topic
from std_msgs.msg import Float64, Int32, String

FLUSH_SECONDS = 2.0
"""A listener that stands still keeps nobody longer than this, s."""


class TrainingTopics:
    """Publishes phase, episode, time left, share, return, success, verdicts and what is left of the practice."""

    def __init__(self, node: Node):
        def publisher(topic: Topic) -> Any:
            return node.create_publisher(topic.msg_type, topic.name, topic.qos)

        self._phase_publisher = publisher(contract.PHASE)
        self._episode = publisher(contract.EPISODE)
        self._time_left = publisher(contract.TIME_LEFT)
        self._return = publisher(contract.EPISODE_RETURN)
        self._share = publisher(contract.HUMAN_SHARE)
        self._success = publisher(contract.SUCCESS)
        self._verdict = publisher(contract.VERDICT)
        self._rests_left = publisher(contract.RESTS_LEFT)
        self._told_left = -1
        self.phase = ''

    def enter(self, phase: str) -> None:
        """``teach``, ``learn``, ``test``, ``wait`` or ``done``; published when it changes."""
        if phase != self.phase:
            self.phase = phase
            self._phase_publisher.publish(String(data=phase))

    def episode(self, number: int) -> None:
        """An episode begins."""
        self._episode.publish(Int32(data=number))

    def progress(self, seconds_left: float, human_share: float) -> None:
        """How the episode stands."""
        self.time_left(seconds_left)
        self._share.publish(Float64(data=human_share))

    def time_left(self, seconds: float) -> None:
        """What is left of the episode, or until the next one begins."""
        self._time_left.publish(Float64(data=seconds))

    def episode_return(self, value: float) -> None:
        """An episode has ended."""
        self._return.publish(Float64(data=value))

    def success(self, rate: float) -> None:
        """A test has ended; 0..1."""
        self._success.publish(Float64(data=rate))

    def verdict(self, phase: str, number: int, verdict: Verdict) -> None:
        """What a person says of an episode."""
        self._verdict.publish(KeyValue(key=episode_key(phase, number), value=str(verdict)))

    def rests_left(self, count: int) -> None:
        """What is left to do in the practice; published when it changes."""
        if count != self._told_left:
            self._told_left = count
            self._rests_left.publish(Int32(data=count))

    def flush(self) -> None:
        """Wait until everybody has the last words, or somebody does not take them."""
        for publisher in (self._phase_publisher, self._return, self._success, self._verdict,
                          self._rests_left):
            publisher.wait_for_all_acked(Duration(seconds=FLUSH_SECONDS))
