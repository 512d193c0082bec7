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

"""What a session waits for, since when and why: printed, logged, and published for the screen and the page."""

import math
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from shared_control_ros.reports import values_of, waits_to_be_enabled
from shared_control_ros.watchdog import STANDSTILL

from .node_process import NodeProcess

SAY_AGAIN_AFTER = 15.0
"""A wait that lasts is printed again after this, s."""
LONGEST = {'starting': 6.0, 'tick': 3.0, 'wait': 3.0, 'learn': 15.0, 'episode': 120.0, 'agent': 15.0}
"""What passes without a word, s: a start of a node, the time from tick to tick, from episode to episode, an update, an
episode from end to end, and until the agent says what it does."""
ENDED_AFTER = 30.0
"""A node whose loop has stood still for this long is ended and started again, s. Each reports once a second on
/diagnostics."""


@dataclass(frozen=True)
class Seen:
    """What is known of a session at one moment."""

    starting: tuple[str, ...] = ()
    """Nodes that have not said that they are ready for longer than they should."""
    standing_still: tuple[tuple[str, str], ...] = ()
    """Nodes whose loop stands still, and what is known of that."""
    phase: str | None = None
    """What the agent is at; None: it has said nothing yet."""
    phase_age: float = 0.0
    """Since the phase began, or the session, s."""
    tick_age: float = 0.0
    """Since the last new tick, s."""
    episode_age: float = 0.0
    """Since the last episode came to its end, s."""
    paused: bool = False
    """By a person."""


@dataclass(frozen=True)
class Wait:
    """What a session waits for."""

    what: str
    nodes: tuple[str, ...]
    """Whose reports and warnings may tell why."""
    starts: bool = False
    """Whether it is for nodes to start."""


def wait_of(seen: Seen) -> Wait | None:
    """What the session waits for; None: it goes on."""
    if seen.starting:
        return Wait(f'{" and ".join(seen.starting)} to start', seen.starting, starts=True)
    if seen.standing_still:
        return Wait(' and '.join(f'{name}, whose loop stands still ({state}),' for name, state in seen.standing_still) +
                    ' to go on', tuple(name for name, _ in seen.standing_still))
    if seen.phase is None:
        return Wait('ppo_agent_node to begin', ('ppo_agent_node',)) if seen.phase_age > LONGEST['agent'] else None
    if seen.phase == 'learn':
        return Wait('the robot to learn from the episode', ('ppo_agent_node',)) if (
            seen.phase_age > LONGEST['learn']) else None
    if seen.phase == 'done':
        return None
    if seen.phase == 'wait' and seen.phase_age > LONGEST['wait']:
        return Wait('an episode to begin', ('ppo_agent_node', 'panda_sim_node', 'torque_ctrl_node'))
    if seen.tick_age > LONGEST['tick']:
        if seen.paused:
            return Wait('a person: it is paused', ())
        return Wait('a tick of the simulation', ('panda_sim_node', 'torque_ctrl_node'))
    if seen.phase in ('teach', 'test') and seen.episode_age > LONGEST['episode']:
        return Wait('an episode to come to its end', ('ppo_agent_node',))
    return None


class Waits:
    """Watches the nodes of a session. Where ROS cannot be imported, their processes alone.

    Args:
        nodes: of the session.
        say: prints and logs a line.
    """

    def __init__(self, nodes: list[NodeProcess], say: Callable[[str], None]):
        self._nodes, self._say = nodes, say
        self._graph: _Graph | None = None
        self._wait: Wait | None = None
        self._since = self._next_line = time.monotonic()
        self._stands_still = False
        self._clock = ''
        self._questioned: set[int] = set()
        """Processes that were asked where they stand still."""
        self._held: dict[int, float] = {}
        """When a process was last seen held from outside, s of the monotonic clock."""

    def open(self) -> None:
        """Join the graph."""
        try:
            self._graph = _Graph()
        except Exception as error:  # the session runs without
            self._say(f'what the session waits for is not published: {error}')

    def poll(self) -> None:
        """Look once, and say what is to be said."""
        now = time.monotonic()
        wait = wait_of(self._look(now))
        if wait is not None and self._wait is not None and wait.starts and self._wait.starts:
            self._wait = wait  # one more node, or one less
        elif wait != self._wait:
            if self._wait is not None and self._next_line > self._since + SAY_AGAIN_AFTER / 2:
                self._say(f'no longer waiting for {self._wait.what}, after {now - self._since:.0f} s')
            self._wait, self._since, self._next_line = wait, now, now
            self._clock = time.strftime('%H:%M:%S')
        text = ''
        if wait is not None:
            what = f'for {wait.what} since {self._clock} ({now - self._since:.0f} s)'
            why = self._why(wait.nodes, now)
            text = f'{what}\n{why}' if why else what
            if now >= self._next_line:
                self._say(f'waiting {text}'.replace('\n', '; '))
                self._next_line = now + SAY_AGAIN_AFTER
        if self._graph is not None:
            self._graph.publish(text)
            self._graph.report(now, '' if self._wait is None or not self._stands_still else self._wait.what)

    def learns(self) -> bool:
        """Whether the robot learns from an episode at this moment."""
        return self._graph is not None and self._graph.look(time.monotonic()).phase == 'learn'

    def close(self) -> None:
        """Leave the graph."""
        if self._graph is not None:
            self._graph.close()

    def _look(self, now: float) -> Seen:
        starting = []
        for node in self._nodes:
            if node.is_starting:
                node.wait_ready(0.0)
            if node.is_starting and now - node.started > LONGEST['starting']:
                starting.append(node.name)
        seen = self._graph.look(now) if self._graph is not None else Seen()
        reported = {} if self._graph is None else self._graph.reported
        standing_still = []
        for node in self._nodes:
            learns = node.name == 'ppo_agent_node' and seen.phase in ('learn', 'done')
            since = reported.get(node.name, 0.0)
            if since > node.started and now - since > STANDSTILL and node.exit_code() is None and not learns:
                held_by = node.held_by()
                standing_still.append((node.name, held_by or f'see the end of {node.log_name}'))
                if held_by:
                    self._held[node.pid] = now
                self._end_standstill(node, now - max(since, self._held.get(node.pid, 0.0)))
        self._stands_still = bool(standing_still)
        return replace(seen, starting=tuple(starting), standing_still=tuple(standing_still))

    def _end_standstill(self, node: NodeProcess, seconds: float) -> None:
        """Have the node write into its log where it stands, and end it in the end, if nothing holds it from outside."""
        if node.pid not in self._questioned:
            self._questioned.add(node.pid)
            node.write_traceback()
        elif seconds > ENDED_AFTER:
            self._say(f'{node.name} has stood still for {seconds:.0f} s: it is ended; {node.log_name} has where it '
                      'stood')
            node.kill()

    def _why(self, names: tuple[str, ...], now: float) -> str:
        """What holds one of these nodes until somebody acts, else the newest warning in their logs.

        A controller logs its emergency stop once, and the simulator that waits for it warns again and again. Whatever
        is waited for, without a controller time stands still.
        """
        held_up = '' if self._graph is None else self._graph.held_up((*names, 'torque_ctrl_node'), now)
        return held_up or self._newest_warning(names)

    def _newest_warning(self, names: tuple[str, ...]) -> str:
        found = [(*warning, node.name) for node in self._nodes
                 if node.name in names and (warning := node.newest_warning())]
        return f'{max(found)[2]}: {max(found)[1]}' if found else ''


class _Graph:
    """What is seen of the graph, by a node called ``session``."""

    def __init__(self) -> None:
        from shared_control_ros.processes import adopt_node_environment
        adopt_node_environment()
        import rclpy
        from diagnostic_msgs.msg import DiagnosticStatus
        from rclpy.context import Context
        from rclpy.node import Node
        from shared_control_ros import contract
        from shared_control_ros.fast_loop import Polled
        from std_msgs.msg import String
        self._context = Context()
        rclpy.init(context=self._context, args=['--ros-args', '--disable-external-lib-logs'])
        self._node = Node('session', context=self._context, start_parameter_services=False, enable_rosout=False)
        latched = contract.qos_latched()
        self._phases = Polled(self._node, contract.PHASE, qos_profile=latched)
        self._returns = Polled(self._node, contract.EPISODE_RETURN, qos_profile=latched)
        self._statuses = Polled(self._node, contract.DIAGNOSTICS, depth=50)
        self._publisher = self._node.create_publisher(String, contract.WAITING.name, contract.WAITING.qos)
        self._message = String()
        self.reported: dict[str, float] = {}
        """When each node reported last on /diagnostics, s of the monotonic clock."""
        self._newest: dict[str, DiagnosticStatus] = {}
        """What it reported then."""
        self._statuses_publisher = self._node.create_publisher(
            contract.DIAGNOSTICS.msg_type, contract.DIAGNOSTICS.name, contract.DIAGNOSTICS.qos)
        self._status = DiagnosticStatus(name=self._node.get_fully_qualified_name(), level=DiagnosticStatus.OK)
        self._next_report = 0.0
        self._ticks = ''
        self._looked = self._ticked = self._ended = self._phase_began = time.monotonic()
        self._phase: str | None = None
        self._paused = False

    def look(self, now: float) -> Seen:
        """What is new."""
        if now - self._looked > STANDSTILL / 2:
            self._hear_anew(now)
        self._looked = now
        while (message := self._phases.take()) is not None:
            if message.data != self._phase:
                self._phase, self._phase_began = message.data, now
                self._ticked = now  # what stood still on purpose begins to go on
        while self._returns.take() is not None:
            self._ended = now
        while (message := self._statuses.take()) is not None:
            self._hear(message, now)
        if self._phase not in ('teach', 'test', 'wait') or self._paused:
            self._ended = now
        return Seen(phase=self._phase, phase_age=now - self._phase_began, tick_age=now - self._ticked,
                    episode_age=now - self._ended, paused=self._paused)

    def _hear_anew(self, now: float) -> None:
        """This process itself was stopped (Ctrl-Z): it has heard of nobody, whatever they did."""
        self.reported = dict.fromkeys(self.reported, now)
        self._ticked = self._ended = self._phase_began = now

    def _hear(self, message: Any, now: float) -> None:
        """Simulators report their ticks once a second, and whether they are paused, that also at once."""
        for status in message.status:
            name = status.name.rpartition('/')[2]
            self.reported[name], self._newest[name] = now, status
            values = values_of(status)
            if 'ticks' in values:
                was_paused, self._paused = self._paused, values.get('paused') == 'True'
                if values['ticks'] != self._ticks or (was_paused and not self._paused):
                    self._ticks, self._ticked = values['ticks'], now

    def held_up(self, names: tuple[str, ...], now: float) -> str:
        """Which of these nodes reports an error or waits to be enabled, and what it says to do; empty: none."""
        from diagnostic_msgs.msg import DiagnosticStatus
        for name in names:
            if now - self.reported.get(name, -math.inf) > STANDSTILL:
                continue
            status = self._newest[name]
            if status.level == DiagnosticStatus.ERROR or waits_to_be_enabled(values_of(status)):
                return f'{name}: {status.message}'
        return ''

    def publish(self, text: str) -> None:
        """What the session waits for, as /session/waiting has it."""
        if text != self._message.data:
            self._message.data = text
            self._publisher.publish(self._message)

    def report(self, now: float, standing_still: str) -> None:
        """Report on /diagnostics, once a second, a loop that stands still, and then that none does any more."""
        from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
        level = DiagnosticStatus.ERROR if standing_still else DiagnosticStatus.OK
        if now < self._next_report or (level == self._status.level and not standing_still):
            return
        self._next_report = now + 1.0
        self._status.level, self._status.message = level, standing_still or 'ok'
        message = DiagnosticArray(status=[self._status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._statuses_publisher.publish(message)

    def close(self) -> None:
        """Leave the graph."""
        with suppress(Exception):
            self._node.destroy_node()
            self._context.try_shutdown()
