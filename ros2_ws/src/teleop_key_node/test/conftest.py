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

"""The node as a process of its own, on a DDS domain of its own, without and with a terminal."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import pytest
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_testing.nodes import domain_id
from shared_control_testing.terminal import Terminal
from std_msgs.msg import Int32, String

_COMMAND = [sys.executable, '-m', 'teleop_key_node.node', '--ros-args']


__all__ = ['domain_id']


def _environment() -> dict[str, str]:
    """The environment of the node's process; :func:`domain_id` has set what concerns DDS."""
    return os.environ | {'TERM': 'xterm-256color', 'LC_ALL': 'C.UTF-8', 'PYTHONUNBUFFERED': '1'}


def _until(happened: Callable[[], object], what: str, timeout: float = 60.0) -> None:
    """Wait until something has happened."""
    deadline = time.monotonic() + timeout
    while not happened():
        assert time.monotonic() < deadline, f'waited {timeout} s in vain for {what}'
        time.sleep(0.01)


class Graph:
    """The rest of the graph, as the test plays it."""

    until = staticmethod(_until)

    def __init__(self, domain: int):
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = Node('rest_of_the_graph', context=self.context)
        self.wrenches = Polled(self.node, contract.HUMAN_WRENCH, depth=500)
        self.joys = Polled(self.node, contract.KEYS, depth=500)
        self._keys = self.publisher(contract.KEYS)
        self._phase = self.publisher(contract.PHASE)
        self._episode = self.publisher(contract.EPISODE)
        self.m_y = float('nan')
        self.received = 0
        self.stamps: list[int] = []

    def publisher(self, topic: contract.Topic):
        return self.node.create_publisher(topic.msg_type, topic.name, topic.qos)

    def polled(self, topic: contract.Topic) -> Polled:
        return Polled(self.node, topic, depth=50)

    def press(self, *buttons: int, source: str = 'test') -> None:
        """One state of the buttons."""
        message = Joy(buttons=buttons)
        message.header.frame_id = source
        self._keys.publish(message)

    def begin(self, phase: str, episode: int | None = None) -> None:
        if episode is not None:
            self._episode.publish(Int32(data=episode))
        self._phase.publish(String(data=phase))

    def listen(self) -> float:
        """The newest M_yh."""
        while (message := self.wrenches.take()) is not None:
            assert message.header.frame_id == 'panda_link0'
            self.m_y = message.wrench.torque.y
            self.stamps.append(message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec)
            self.received += 1
        return self.m_y

    def expect(self, m_y: float) -> None:
        """Wait for M_yh to become ``m_y``."""
        self.until(lambda: self.listen() == m_y, f'M_yh = {m_y} N m (now {self.m_y})')

    def hold(self, m_y: float, seconds: float) -> None:
        """M_yh is ``m_y`` for some time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            assert self.listen() == m_y
            time.sleep(0.02)

    def wait_for_node(self, meanwhile: Callable[[], None]) -> None:
        """Until the node publishes and hears."""
        self.until(lambda: meanwhile() or (
            self.listen() == 0.0 and self._keys.get_subscription_count() >= 2
            and self._phase.get_subscription_count() >= 1), 'the node')

    def close(self) -> None:
        self.node.destroy_node()
        self.context.try_shutdown()


class Process:
    """The node without a terminal."""

    def __init__(self, *parameters: str, **popen):
        arguments = [word for parameter in parameters for word in ('-p', parameter)]
        popen = {'start_new_session': True, 'stdin': subprocess.DEVNULL, 'stdout': subprocess.PIPE,
                 'stderr': subprocess.STDOUT} | popen
        self.popen = subprocess.Popen(
            _COMMAND + arguments, env=_environment(), **popen)

    def stop(self, number: int = signal.SIGTERM) -> int:
        """Send a signal; the exit code."""
        self.popen.send_signal(number)
        return self.popen.wait(60)

    def output(self) -> str:
        """What it said; call it when it has ended."""
        return self.popen.communicate()[0].decode()

    def close(self) -> None:
        try:
            self.stop()
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()
        if self.popen.stdout is not None:
            self.popen.stdout.close()


class TerminalProcess(Process, Terminal):
    """The node in a terminal."""

    def __init__(self, *parameters: str):
        Terminal.__init__(self)
        self.modes_before = self.modes
        Process.__init__(self, *parameters, **self.popen_options())
        self.watch()

    def expect(self, text: str, after: int = 0) -> None:
        """Wait until ``text`` is on the screen."""
        _until(lambda: text in self.shown[after:], f'{text!r} on the screen')

    def close(self) -> None:
        Process.close(self)
        Terminal.close(self)


@pytest.fixture
def graph(domain_id: int) -> Iterator[Graph]:
    graph = Graph(domain_id)
    yield graph
    graph.close()


@pytest.fixture
def start(graph: Graph) -> Iterator[Callable[..., Process]]:
    """Start the node without a terminal and wait for it."""
    started: list[Process] = []

    def start(*parameters: str, kind: type = Process, meanwhile: Callable[[], None] = lambda: None):
        started.append(kind(*parameters))
        graph.wait_for_node(meanwhile)
        return started[-1]
    yield start
    for process in started:
        process.close()


@pytest.fixture
def start_in_terminal(start) -> Callable[..., TerminalProcess]:
    """Start the node in a terminal and wait for it."""
    return lambda *parameters: start(*parameters, kind=TerminalProcess)


@pytest.fixture
def run_to_its_end(domain_id: int) -> Callable[..., subprocess.CompletedProcess]:
    """Run the node, which is to end by itself."""
    return lambda *parameters: subprocess.run(
        [*_COMMAND, *(word for parameter in parameters for word in ('-p', parameter))],
        env=_environment(), capture_output=True, text=True, timeout=60)
