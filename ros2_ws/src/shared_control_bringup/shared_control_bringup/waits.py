"""What a session waits for, since when and why: printed, logged, and published for the screen and the page."""

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from .node_process import NodeProcess

SAY_AGAIN_AFTER = 15.0
"""A wait that lasts is printed again after this, s."""
LONGEST = {'starting': 6.0, 'tick': 3.0, 'wait': 3.0, 'learn': 15.0, 'episode': 120.0, 'agent': 15.0}
"""What passes without a word, s: a start of a node, the time from tick to tick, from episode to episode, an update, an
episode from end to end, and until the agent says what it does."""


@dataclass(frozen=True)
class Seen:
    """What is known of a session at one moment."""

    starting: tuple[str, ...] = ()
    """Nodes that have not said that they are ready for longer than they should."""
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
    """Whose warnings may tell why."""


def wait_of(seen: Seen) -> Wait | None:
    """What the session waits for; None: it goes on."""
    if seen.starting:
        return Wait(f'{" and ".join(seen.starting)} to start', seen.starting)
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
        self._clock = ''

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
        if wait != self._wait:
            if self._wait is not None and self._next_line > self._since + SAY_AGAIN_AFTER / 2:
                self._say(f'no longer waiting for {self._wait.what}, after {now - self._since:.0f} s')
            self._wait, self._since, self._next_line = wait, now, now
            self._clock = time.strftime('%H:%M:%S')
        text = ''
        if wait is not None:
            what = f'for {wait.what} since {self._clock} ({now - self._since:.0f} s)'
            why = self._newest_warning(wait.nodes)
            text = f'{what}\n{why}' if why else what
            if now >= self._next_line:
                self._say(f'waiting {text}'.replace('\n', '; '))
                self._next_line = now + SAY_AGAIN_AFTER
        if self._graph is not None:
            self._graph.publish(text)

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
        return replace(seen, starting=tuple(starting))

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
        self._ticks = ''
        self._ticked = self._ended = self._phase_began = time.monotonic()
        self._phase: str | None = None
        self._paused = False

    def look(self, now: float) -> Seen:
        """What is new."""
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

    def _hear(self, message: Any, now: float) -> None:
        """Simulators report their ticks once a second, and whether they are paused."""
        for status in message.status:
            values = {value.key: value.value for value in status.values}
            if 'ticks' in values:
                self._paused = values.get('paused') == 'True'
                if values['ticks'] != self._ticks:
                    self._ticks, self._ticked = values['ticks'], now

    def publish(self, text: str) -> None:
        """What the session waits for, as /session/waiting has it."""
        if text != self._message.data:
            self._message.data = text
            self._publisher.publish(self._message)

    def close(self) -> None:
        """Leave the graph."""
        with suppress(Exception):
            self._node.destroy_node()
            self._context.try_shutdown()
