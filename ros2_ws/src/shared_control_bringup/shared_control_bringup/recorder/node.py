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

"""session_recorder_node: records every topic of the contract into an MCAP bag that ``ros2 bag`` reads."""

import itertools
import sys
import time
from collections import deque
from pathlib import Path

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from shared_control_records.bag.last_sent import last_sent
from shared_control_records.bag.metadata import refuse_another_recorder
from shared_control_records.bag.writer import BagWriter
from shared_control_ros import contract
from shared_control_ros.clock_steps import ClockSteps, in_words
from shared_control_ros.contract import Topic
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.parameters import ParameterError, declare
from shared_control_ros.runner import Stop
from shared_control_ros.runner import run as run_node

from .topic_info import message_type, qos_yaml

POLL_PERIOD = 0.02
"""s. Taking what has come every 20 ms costs a fraction of waking up for every message."""
SERVICE_POLLS = 5
"""Services (parameters) are looked after every so many polls: that costs as much as a poll."""
LAST_WAIT = 0.25
"""s. What was sent before the recorder is stopped may still be on its way, on a busy machine for tens of ms."""


class RecordedTopic:
    """One topic on its way into the bag."""

    def __init__(self, node: Node, topic: Topic):
        self._node = node
        self._topic = topic
        self._subscription = Polled(node, topic, raw=True, qos_profile=QoSProfile(
            depth=contract.RECORDER_DEPTH, reliability=topic.qos.reliability, durability=topic.qos.durability))
        self._waiting: deque[tuple[bytes, dict]] = deque()
        self.name = self._subscription.topic_name
        self.latched = topic.qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
        self.depth = topic.qos.depth
        self.recorded: set[int] = set()
        """Messages sent at these times, ns, are in the bag already and may come once more."""
        self._sequence = 0
        self._gaps = 0
        self._publishers = 0

    def collect(self) -> None:
        """Take all messages that have come into memory, so that the middleware drops none."""
        while (taken := self._subscription.take_with_info()) is not None:
            self._waiting.append(taken)

    def announce(self, bag: BagWriter) -> None:
        """Say where to write."""
        described = message_type(self._topic.msg_type)
        self._bag = bag
        self._channel = bag.add_topic(
            self.name, described.name, described.definition, described.type_hash, qos_yaml(self._topic.qos))

    def drain(self, received_after_ns: int = 0) -> None:
        """Write all messages that have come; those alone that came after a time of the day, when that is given."""
        self.collect()
        while self._waiting and self._waiting[0][1]['received_timestamp'] >= received_after_ns:
            data, info = self._waiting.popleft()
            if info['source_timestamp'] in self.recorded:
                continue
            sequence = info['publication_sequence_number'] or 0
            if sequence > self._sequence + 1 and self._sequence:
                self._gaps += sequence - self._sequence - 1
            self._sequence = sequence
            self._bag.write(self._channel, data, info['source_timestamp'], info['received_timestamp'], sequence)

    def lost(self) -> int:
        """Messages that were published since the last call but did not come.

        Told by the publisher's count of its messages; several publishers count each on their own, and then it cannot
        be told and is 0.
        """
        gaps, self._gaps = self._gaps, 0
        before, self._publishers = self._publishers, self._node.count_publishers(self.name)
        return gaps if before <= 1 and self._publishers <= 1 else 0


class SessionRecorder:
    """The node: takes serialized messages and writes them as they are."""

    def __init__(self) -> None:
        # Bags are stamped by the wall clock, as rosbag2 does by default.
        self.node = Node('session_recorder_node', parameter_overrides=[Parameter('use_sim_time', value=False)])
        output = declare(self.node, 'output', '', "The bag's folder; made when it is missing.")
        if not output:
            raise ParameterError("parameter 'output' is missing: the folder to record into, -p output:=FOLDER")
        refuse_another_recorder(Path(output).expanduser())
        self._flush_period: float = declare(
            self.node, 'flush_period', 0.25, 'At most this much is lost when the recorder is killed.',
            unit='s', minimum=0.05, maximum=0.5)
        self._split_seconds: float = 60.0 * declare(
            self.node, 'split_minutes', 15.0, 'The bag goes on in another file after this; 0: never.', unit='min',
            minimum=0.0, maximum=1440.0)
        self._split_bytes: float = 1e6 * declare(
            self.node, 'split_megabytes', 1000.0, 'The bag goes on in another file after this much; 0: never.',
            unit='MB', minimum=0.0, maximum=1e6)
        self._topics = [RecordedTopic(self.node, topic) for topic in contract.BAG_TOPICS]
        # After a long recording was killed, this takes a while. What comes meanwhile is recorded, too.
        self._open(output)
        for recovered in self._bag.recovered:
            self.node.get_logger().warning(f'finished what a killed recorder left behind: {recovered}')
        latched = {topic.name: topic for topic in self._topics if topic.latched}
        depths = {name: topic.depth for name, topic in latched.items()}
        for name, sent in last_sent(self._bag.previous_files, depths).items():
            latched[name].recorded = sent
        self._diagnostics = Diagnostics(self.node, POLL_PERIOD)
        self._background = Background(self.node)
        self._clock_steps = ClockSteps()
        self._clock_problem: dict[str, str] = {}
        """That the clock was set, until it is reported."""
        self._lost = 0
        self._messages = self._bytes = 0
        """In the files before this one."""
        self.node.get_logger().info(f'recording {len(self._topics)} topics into {self._bag.path}')

    def _open(self, bag: str | Path) -> None:
        """Begin the next file of the bag."""
        self._bag = BagWriter(bag, meanwhile=self._collect)
        self._began = time.monotonic()
        for topic in self._topics:
            topic.announce(self._bag)

    def _split_if_full(self) -> None:
        """Go on in another file. What comes meanwhile waits with the middleware."""
        seconds, size = time.monotonic() - self._began, self._bag.bytes
        if 0.0 < self._split_seconds <= seconds or 0.0 < self._split_bytes <= size:
            self._split()

    def _split(self) -> None:
        self._bag.finish()
        self._messages += self._bag.messages
        self._bytes += self._bag.bytes
        self._open(self._bag.bag)

    def _follow_the_clock(self) -> None:
        """Say that the clock was set; go on in another file when it was set back: within one, times run forwards."""
        step = self._clock_steps.new()
        if not step:
            return
        what = in_words(step)
        if step < 0.0:
            what += ': the bag goes on in another file, and nothing is lost'
            self._drain(received_after_ns=time.time_ns() - round(step / 2 * 1e9))
            self._split()
        self.node.get_logger().warning(what)
        self._clock_problem = {'clock': what}

    def run(self, stop: Stop) -> None:
        """Record until ``stop.requested``, then finish the file."""
        next_flush = time.monotonic() + self._flush_period
        for poll in itertools.count():
            if stop.requested:
                break
            started = time.monotonic()
            self._diagnostics.tick()
            self._follow_the_clock()
            self._drain()
            if started >= next_flush:
                self._bag.flush()
                self._split_if_full()
                next_flush = started + self._flush_period
            if self._diagnostics.due():
                self._report()
            if poll % SERVICE_POLLS == 0:
                self._background.poll()
            time.sleep(max(0.0, started + POLL_PERIOD - time.monotonic()))
        time.sleep(LAST_WAIT)
        self._drain()
        self._bag.finish()
        self.node.get_logger().info(f'{self._bag.messages} messages in {self._bag.path}')

    def close(self) -> None:
        """Finish the file after an error elsewhere; after :meth:`run` there is nothing left to do."""
        self._bag.finish()
        self._background.close()

    def _collect(self) -> None:
        for topic in self._topics:
            topic.collect()

    def _drain(self, received_after_ns: int = 0) -> None:
        for topic in self._topics:
            topic.drain(received_after_ns)

    def _report(self) -> None:
        lost = {topic.name: count for topic in self._topics if (count := topic.lost())}
        self._lost += sum(lost.values())
        self._diagnostics.publish(
            {name: f'{count} messages lost in the last second' for name, count in lost.items()} | self._clock_problem,
            messages=self._messages + self._bag.messages, lost=self._lost, bytes=self._bytes + self._bag.bytes)
        self._clock_problem = {}


def main(args: list[str] | None = None) -> int:
    """Entry point of ``ros2 run shared_control_bringup session_recorder_node``."""
    return run_node(SessionRecorder, args)


if __name__ == '__main__':
    sys.exit(main())
