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
from collections import Counter
from collections.abc import Callable

from shared_control_ros.watchdog import STANDSTILL

from .node_process import UNUSABLE, NodeProcess

MAX_RESTARTS = 5
"""In a row, of a node that dies each time before it was ready for ``HEALTHY_SECONDS``."""
HEALTHY_SECONDS = 20.0
"""Twice what a loop may stand still before it is ended, s."""
READY_SECONDS = 60.0
"""Until the first ready or not, all nodes together, s: a busy machine takes long to import torch."""
START_POLL_SECONDS = 0.02
STOP_POLL_SECONDS = 0.1
STOP_SECONDS = 10.0
"""How long a node may take to leave, s."""
COMPUTES = 0.1
"""A process computes as long as it has a core for this share of the time, on however busy a machine."""


class SessionError(RuntimeError):
    """The session cannot go on; the message says why and which log tells more."""


class StoppedByNode(Exception):
    """The person stopped the session at a node."""


class Supervisor:
    """Runs nodes until one of them, the leader, is done.

    Args:
        nodes: they stop in the reverse order.
        leader: the node that ends the session when it has done all.
        say: told of every restart.
        stopper: the node that stops the session when it has done all.
        attend: called again and again while nodes start; may raise to give up.
    """

    def __init__(self, nodes: list[NodeProcess], leader: str, say: Callable[[str], None], stopper: str = '',
                 attend: Callable[[], None] = lambda: None):
        self._nodes = nodes
        self._leader = leader
        self._stopper = stopper
        self._say = say
        self._attend = attend
        self._early_deaths: Counter[str] = Counter()

    def start(self) -> None:
        """Start the nodes side by side, but for those that wait for another, and wait until all are ready.

        Raises:
            SessionError: a node cannot run with its parameters or files.
        """
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
                _require_usable(node)
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
            if node.name == self._leader and node.has_done:
                return False
            if node.name == self._stopper and node.has_done:
                raise StoppedByNode
            _require_usable(node)
            self._restart(node, code)
        return True

    def _restart(self, node: NodeProcess, code: int) -> None:
        if time.monotonic() - node.ready_since > HEALTHY_SECONDS:
            self._early_deaths[node.name] = 0
        self._early_deaths[node.name] += 1
        if self._early_deaths[node.name] > MAX_RESTARTS:
            raise SessionError(
                f'{node.name} died {self._early_deaths[node.name]} times in a row, each time before it was ready for '
                f'{HEALTHY_SECONDS:.0f} s ({_meaning(code)}): {node.last_error()}; see {node.log}')
        self._say(f'{node.name} died ({_meaning(code)}); starting it again')
        node.start()

    def stop(self, but: str = '', say: Callable[[str], None] = print, learns: Callable[[], bool] = lambda: False,
             asked: Callable[[], int] = lambda: 0) -> None:
        """Stop the nodes, the last one started first, and wait for each; leave the one called ``but`` alone.

        Args:
            say: told what is waited for, and what does not leave.
            learns: whether the leader learns from an episode: as long as it computes, it is waited for.
            asked: how often somebody has asked to stop; who asks again does not want to wait for that.
        """
        for node in reversed(self._nodes):
            if node.name == but:
                continue
            node.interrupt()
            if node.has_left(STOP_SECONDS) or (
                    node.name == self._leader and learns() and _has_learned(node, say, asked)):
                continue
            end_by_force(node, say)

    @property
    def restarts(self) -> int:
        """How often a node was started again."""
        return sum(max(node.starts - 1, 0) for node in self._nodes)


def _has_learned(node: NodeProcess, say: Callable[[str], None], asked: Callable[[], int]) -> bool:
    """Let it finish what it computes: an episode has taken a person's time; whether it has left."""
    say(f'{node.name} still learns from the last episode, and is waited for; Ctrl-C again ends it, and that episode is '
        'lost')
    before, used, since = asked(), node.cpu_seconds(), time.monotonic()
    while asked() == before:
        if node.has_left(STOP_POLL_SECONDS):
            return True
        if time.monotonic() - since > STOP_SECONDS:
            if node.cpu_seconds() - used < COMPUTES * STOP_SECONDS:
                return False
            used, since = node.cpu_seconds(), time.monotonic()
    return False


def end_by_force(node: NodeProcess, say: Callable[[str], None]) -> None:
    """End a node that does not leave, and say so."""
    say(f'{node.name} did not leave when it was asked to, and is ended by force; see {node.log_name}')
    node.wait(0.0)


def _require_usable(node: NodeProcess) -> None:
    if node.exit_code() == UNUSABLE:
        raise SessionError(f'{node.name}: {node.last_error()}')


def _meaning(code: int) -> str:
    if code == -signal.SIGALRM:
        return f'it stood still for {STANDSTILL:.0f} s'
    if code == 0:
        return 'somebody ended it'
    return f'signal {-code}' if code < 0 else f'exit code {code}'
