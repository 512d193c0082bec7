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

"""Pytest fixtures for tests with real nodes over real DDS, each in a domain of its own.

A test folder takes them over with ``from shared_control_testing.nodes import *`` in its ``conftest.py``. They last as
long as a test class: tests that can share a running node stand in one class, all others get nodes of their own.
"""

import fcntl
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import copy
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from shared_control.processes import leave_with_the_parent
from shared_control_ros.contract import Topic
from shared_control_ros.fast_loop import Polled
from shared_control_ros.processes import node_environment, node_module

__all__ = ['domain_id', 'observer', 'start_node']

DOMAINS = range(1, 100)
"""Domain ids whose ports lie outside the range that Linux hands out to others."""


@contextmanager
def free_domain() -> Iterator[int]:
    """A ROS domain that no other test on this machine uses at the moment, for this process and those it starts."""
    for candidate in DOMAINS:
        # Not in TMPDIR: the nodes of two runs of the tests would meet, whatever each calls its temporary folder.
        lock = (Path('/tmp') / f'shared_control_domain_{candidate}.lock').open('w')
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        with (lock, pytest.MonkeyPatch.context() as monkeypatch,
              tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home):  # what nodes keep there ends with them
            for variable, value in {
                    **node_environment(), 'ROS_DOMAIN_ID': str(candidate), 'ROS_HOME': home}.items():
                monkeypatch.setenv(variable, value)
            yield candidate
        return
    raise RuntimeError('all ROS domains are in use by other tests')


@pytest.fixture(scope='class')
def domain_id() -> Iterator[int]:
    """See :func:`free_domain`."""
    with free_domain() as domain:
        yield domain


class RunningNode:
    """A node in a process of its own."""

    def __init__(self, package: str, name: str, parameters: dict[str, Any], log: Path, python: str = sys.executable):
        command = [python, '-m', node_module(package), '--ros-args', '-r', f'__node:={name or package}']
        for name, value in parameters.items():
            command += ['-p', f'{name}:={_yaml(value)}']
        self.log_file = log
        with log.open('wb') as output:
            self.process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=output, stderr=output, start_new_session=True,
                preexec_fn=leave_with_the_parent)

    def log(self) -> str:
        """What it has printed so far."""
        return self.log_file.read_text(errors='replace')

    def stop(self, number: int = signal.SIGINT, timeout: float = 60.0) -> int:
        """Send a signal and give the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            return self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise

    def wait_for_log(self, text: str, timeout: float = 60.0, beside: Callable[[], Any] = lambda: None) -> None:
        """Wait until it has printed ``text``; ``beside()`` is called again and again until then."""
        deadline = time.monotonic() + timeout
        while text not in self.log():
            assert time.monotonic() < deadline, f'{text!r} is not in the log:\n{self.log()}'
            assert self.process.poll() is None or text in self.log(), f'it ended without {text!r}:\n{self.log()}'
            beside()
            time.sleep(0.05)


def _yaml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return '[' + ', '.join(_yaml(v) for v in value) + ']'
    return str(value)


@contextmanager
def running_nodes(logs: Path) -> Iterator[Callable[..., RunningNode]]:
    """``start(package, name="", python=sys.executable, **parameters)`` starts a node, under another name if given.

    All of them are ended in the end.
    """
    nodes: list[RunningNode] = []

    def start(package: str, name: str = '', python: str = sys.executable, **parameters: Any) -> RunningNode:
        nodes.append(RunningNode(package, name, parameters, logs / f'{len(nodes)}_{package}.log', python))
        return nodes[-1]

    try:
        yield start
    finally:
        for node in nodes:
            if node.process.poll() is None:
                node.process.terminate()
        for node in nodes:
            node.stop(signal.SIGTERM)


@pytest.fixture(scope='class')
def start_node(domain_id: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., RunningNode]]:
    """See :func:`running_nodes`."""
    with running_nodes(tmp_path_factory.mktemp('logs')) as start:
        yield start


ASK_AGAIN_S = 15.0
"""After so long a response does not come any more."""


class Observer:
    """A node of the test itself, in the test's process."""

    def __init__(self, domain: int):
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = Node('observer', context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._inputs: list[tuple[Polled, list[Any]]] = []

    def listen(self, topic: Topic, depth: int = 2000) -> list[Any]:
        """A list that grows with every message of a topic of the contract while :meth:`spin` runs."""
        profile = copy(topic.qos)
        profile.depth = depth
        messages: list[Any] = []
        # Taken by hand: an executor's callbacks are too slow for 1 kHz.
        self._inputs.append((Polled(self.node, topic, qos_profile=profile), messages))
        return messages

    def take_all(self) -> None:
        """Move what waits into the lists, and serve nothing else."""
        for polled, messages in self._inputs:
            while (message := polled.take()) is not None:
                messages.append(message)

    def _serve(self, timeout: float) -> None:
        self.take_all()
        self._executor.spin_once(timeout_sec=timeout)

    def publisher(self, topic: Topic) -> Any:
        """A publisher on a topic of the contract."""
        return self.node.create_publisher(topic.msg_type, topic.name, topic.qos)

    def spin(self, until: Callable[[], Any], timeout: float = 60.0, what: str = '') -> Any:
        """Serve callbacks until ``until()`` is true, and give its value; fail after ``timeout`` seconds."""
        deadline = time.monotonic() + timeout
        while not (value := until()):
            assert time.monotonic() < deadline, f'waited {timeout} s in vain{": " + what if what else ""}'
            self._serve(0.01)
        return value

    def spin_for(self, seconds: float) -> None:
        """Serve callbacks for so long."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            self._serve(0.01)

    def call(self, service_type: type, name: str, request: Any, timeout: float = 60.0,
             beside: Callable[[], Any] = lambda: None) -> Any:
        """Call a service and give its response; ``beside()`` is called again and again until that is there.

        It is called again after a while: a response is lost that comes before the server has found who asked.
        """
        client = self.node.create_client(service_type, name)
        deadline = time.monotonic() + timeout
        while not client.service_is_ready():
            assert time.monotonic() < deadline, f'no service {name}'
            beside()
            self._serve(0.01)
        futures = []
        again = 0.0

        def answered() -> Any:
            nonlocal again
            beside()
            if time.monotonic() >= again:
                again = time.monotonic() + ASK_AGAIN_S
                futures.append(client.call_async(request))
            return next((future for future in futures if future.done()), None)

        response = self.spin(answered, timeout, f'response of {name}').result()
        self.node.destroy_client(client)
        return response

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture(scope='class')
def observer(domain_id: int) -> Iterator[Observer]:
    """A node in the test's process, in the test's domain."""
    observer = Observer(domain_id)
    yield observer
    observer.close()
