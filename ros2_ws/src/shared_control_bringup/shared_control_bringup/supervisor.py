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

"""Keeps the nodes of a session alive and stops them in order."""

import signal
import time
from collections.abc import Callable

from shared_control_ros.watchdog import STANDSTILL

from .node_process import UNUSABLE, NodeProcess

MAX_RESTARTS_A_MINUTE = 5
READY_SECONDS = 60.0
"""Until the first ready or not, all nodes together, s: a busy machine takes long to import torch."""
START_POLL_SECONDS = 0.02
STOP_SECONDS = 10.0


class SessionError(RuntimeError):
    """The session cannot go on; the message says why and which log tells more."""


class StoppedByNode(Exception):
    """The person stopped the session at a node."""


class Supervisor:
    """Runs nodes until one of them, the leader, is done.

    Args:
        nodes: they stop in the reverse order.
        leader: the node whose clean exit ends the session.
        say: told of every restart.
        stopper: the node whose clean exit stops the session.
        attend: called again and again while nodes start; may raise to give up.
    """

    def __init__(self, nodes: list[NodeProcess], leader: str, say: Callable[[str], None], stopper: str = '',
                 attend: Callable[[], None] = lambda: None):
        self._nodes = nodes
        self._leader = leader
        self._stopper = stopper
        self._say = say
        self._attend = attend
        self._deaths: dict[str, list[float]] = {}

    def start(self) -> None:
        """Start the nodes side by side, but for those that wait for another, and wait until all are ready."""
        deadline = time.monotonic() + READY_SECONDS
        waiting = list(self._nodes)
        while waiting or any(node.is_starting for node in self._nodes):
            self._attend()
            late = time.monotonic() >= deadline
            unready = {node.name for node in self._nodes if node in waiting or node.is_starting}
            for node in [node for node in waiting if late or node.after not in unready]:
                node.start(confined=False)
                waiting.remove(node)
            if late:
                break
            for node in self._nodes:
                node.wait_ready(0.0)
            time.sleep(START_POLL_SECONDS)
        for node in self._nodes:
            node.confine()

    def poll(self) -> bool:
        """Look after the nodes once; False when the leader has finished.

        Raises:
            SessionError: a node cannot run with its parameters, or dies again and again.
            StoppedByNode: the node at which a person can stop the session has ended.
        """
        for node in self._nodes:
            code = node.exit_code()
            if code is None:
                continue
            if node.name == self._leader and code == 0:
                return False
            if node.name == self._stopper and code == 0:
                raise StoppedByNode
            if code == UNUSABLE:
                raise SessionError(f'{node.name}: {node.last_error()}')
            self._restart(node, code)
        return True

    def _restart(self, node: NodeProcess, code: int) -> None:
        now = time.monotonic()
        deaths = self._deaths[node.name] = [t for t in self._deaths.get(node.name, []) if now - t < 60.0] + [now]
        if len(deaths) > MAX_RESTARTS_A_MINUTE:
            raise SessionError(
                f'{node.name} died {len(deaths)} times within a minute ({_meaning(code)}): {node.last_error()}; '
                f'see {node.log}')
        self._say(f'{node.name} died ({_meaning(code)}); starting it again')
        node.start()

    def stop(self, but: str = '') -> None:
        """Stop the nodes, the last one started first, and wait for each; leave the one called ``but`` alone."""
        for node in reversed(self._nodes):
            if node.name == but:
                continue
            node.interrupt()
            node.wait(STOP_SECONDS)

    @property
    def restarts(self) -> int:
        """How often a node was started again."""
        return sum(max(node.starts - 1, 0) for node in self._nodes)


def _meaning(code: int) -> str:
    if code == -signal.SIGALRM:
        return f'it stood still for {STANDSTILL:.0f} s'
    return f'signal {-code}' if code < 0 else f'exit code {code}'
