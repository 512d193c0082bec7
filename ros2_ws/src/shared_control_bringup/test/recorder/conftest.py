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

"""Processes and traffic for the tests of the recorder: real nodes over real DDS, each test in a domain of its own."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from rclpy.context import Context
from rclpy.node import Node
from rclpy.serialization import serialize_message
from shared_control_ros import contract
from shared_control_ros.contract import Topic
from shared_control_testing.nodes import domain_id

__all__ = ['domain_id']

TRAFFIC = (
    (contract.JOINT_STATES, 1), (contract.EFFORT_COMMANDS, 1), (contract.BALL, 10), (contract.CLOCK, 10),
    (contract.APPLIED_WRENCH, 5), (contract.HUMAN_WRENCH, 20), (contract.AGENT_WRENCH, 20))
"""Topics and their periods in ms, as in a session."""


@pytest.fixture
def ros_domain(domain_id: int) -> int:
    """A DDS domain that no other test on this machine uses meanwhile."""
    return domain_id


class Recorder:
    """A recorder in a process of its own."""

    def __init__(self, arguments: list[str], environment: dict[str, str]):
        self.process = subprocess.Popen(
            [sys.executable, '-m', 'shared_control_bringup.recorder.node', '--ros-args', *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})

    def stop(self, how: signal.Signals = signal.SIGINT) -> tuple[int, str]:
        """Send a signal; gives exit code and stderr."""
        self.process.send_signal(how)
        return self.wait()

    def wait(self) -> tuple[int, str]:
        """Exit code and stderr of a recorder that ends by itself."""
        _, errors = self.process.communicate(timeout=60)
        return self.process.returncode, errors


@pytest.fixture
def start_recorder(ros_domain: int) -> Iterator[Callable[..., Recorder]]:
    """Starts recorders: ``start_recorder(bag, environment={}, flush_period=0.1)``."""
    started: list[Recorder] = []

    def start(bag: Path | str | None = None, environment: dict[str, str] | None = None,
              **parameters: object) -> Recorder:
        given = ({} if bag is None else {'output': bag}) | parameters
        recorder = Recorder([part for name, value in given.items() for part in ('-p', f'{name}:={value}')],
                            environment or {})
        started.append(recorder)
        return recorder

    yield start
    for recorder in started:
        if recorder.process.poll() is None:
            recorder.process.kill()
            recorder.process.communicate()


class Traffic:
    """Publishes what a session publishes, and remembers the bytes."""

    def __init__(self, domain: int):
        self._context = Context()
        self._context.init(domain_id=domain)
        self.node = Node('traffic', context=self._context)
        topics = [topic for topic, _ in TRAFFIC] + [contract.EPISODE]
        self._publishers = {
            topic.full_name: self.node.create_publisher(topic.msg_type, topic.name, topic.qos) for topic in topics}
        self._seen: set[bytes] = set()
        self.sent: dict[str, list[bytes]] = {topic: [] for topic in self._publishers}

    def wait_for_recorder(self) -> None:
        """Wait until a recorder that was not there before subscribes to every topic."""
        deadline = time.monotonic() + 60.0
        for topic in self._publishers:
            while not (new := self._subscribers(topic) - self._seen):
                assert time.monotonic() < deadline, f'no recorder subscribes to {topic}'
                time.sleep(0.01)
            self._seen |= new
        time.sleep(1.5)  # the other side must have found this one, too

    def publish(self, topic: Topic, message: object) -> None:
        """Publish and remember one message: as bytes, since its padding differs each time it is serialized."""
        data = serialize_message(message)
        self.sent[topic.full_name].append(data)
        self._publishers[topic.full_name].publish(data)

    def run(self, seconds: float) -> None:
        """Publish at the rates of a session."""
        messages = [(topic, period, topic.msg_type()) for topic, period in TRAFFIC]
        joints, effort = messages[0][2], messages[1][2]
        joints.name = [f'panda_joint{number}' for number in range(1, 8)]
        start = time.perf_counter()
        for tick in range(int(seconds * 1000)):
            joints.position = effort.data = [tick + joint / 8 for joint in range(7)]
            joints.velocity = joints.effort = joints.position
            for topic, period, message in messages:
                if tick % period == 0:
                    self.publish(topic, message)
            time.sleep(max(0.0, start + (tick + 1) * 1e-3 - time.perf_counter()))

    def run_until(self, done: Callable[[], bool]) -> None:
        """Publish at the rates of a session until something has happened."""
        deadline = time.monotonic() + 60.0
        while not done():
            assert time.monotonic() < deadline
            self.run(0.25)

    def close(self) -> None:
        """Leave the graph."""
        self.node.destroy_node()
        self._context.try_shutdown()

    def _subscribers(self, topic: str) -> set[bytes]:
        return {bytes(endpoint.endpoint_gid) for endpoint in self.node.get_subscriptions_info_by_topic(topic)}


@pytest.fixture
def traffic(ros_domain: int) -> Iterator[Traffic]:
    """A publisher in the test's own process."""
    traffic = Traffic(ros_domain)
    yield traffic
    traffic.close()


@pytest.fixture(autouse=True)
def no_stray_processes() -> Iterator[None]:
    """No test leaves a child behind. Other tests of this process may have: a resource tracker of multiprocessing."""
    before = _children()
    yield
    assert _children() <= before


def _children() -> set[str]:
    """The ids of this process' children."""
    lists = Path(f'/proc/{os.getpid()}/task').glob('*/children')
    return {child for children in lists for child in children.read_text().split()}
