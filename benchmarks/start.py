"""How long a person waits: CPU seconds of ``--help``, and seconds from the command of a session to its first episode.

A session with a simulated tutor is started as anybody starts one. The time of a node is when it said that it was ready,
in its log; the first tick is the first stamp on /joint_states_throttle that follows another, the first episode is the
phase ``teach``.
"""

import re
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

ROUNDS = 3
GIVEN_UP_AFTER = 180.0
"""s"""
_READY = re.compile(r'^\[INFO\] \[([\d.]+)\] \[[^\]]*\]: ready$', re.MULTILINE)
FOLDER = Path(sys.executable).parent


def help_cpu_s() -> dict[str, float]:
    """CPU seconds of ``--help``, by command; medians."""
    subcommands = [entry.name for entry in entry_points(group='shared_control.commands')]
    nodes = {entry.name for entry in entry_points(group='console_scripts') if entry.name.endswith('_node')
             and entry.value.endswith('.__main__:main')}
    commands = [['shared-control'], *(['shared-control', name] for name in sorted(subcommands)),
                *([name] for name in sorted(nodes))]
    return {' '.join(command): round(statistics.median(_cpu([str(FOLDER / command[0]), *command[1:], '--help'])
                                                       for _ in range(ROUNDS)), 3) for command in commands}


def _cpu(command: list[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def session_s() -> dict[str, float]:
    """Seconds from the command to each node's readiness, to the first tick and to the first episode."""
    from shared_control.processes import leave_with_the_parent
    from shared_control_testing.nodes import free_domain
    with tempfile.TemporaryDirectory() as folder, free_domain() as domain:
        session = Path(folder) / 'session'
        with _Graph(domain) as graph:
            began, clock = time.monotonic(), time.time()
            process = subprocess.Popen(
                [str(FOLDER / 'shared-control'), 'session', '--tutor', 'sim', '--no-screen', '--episodes', '1',
                 '--test-episodes', '0', '--output', str(session)],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, preexec_fn=leave_with_the_parent)
            try:
                found = graph.first_tick_and_episode(began)
            finally:
                process.send_signal(signal.SIGINT)
                process.wait()
        for log in (session / 'log').glob('*_node.log'):
            for stamp in _READY.findall(log.read_text())[:1]:
                found[log.stem] = round(float(stamp) - clock, 2)
    return dict(sorted(found.items(), key=lambda item: item[1]))


class _Graph:
    """Listens on the graph."""

    def __init__(self, domain: int):
        import rclpy
        from rclpy.context import Context
        from rclpy.node import Node
        from shared_control_ros import contract
        from shared_control_ros.fast_loop import Polled
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = Node('bench', context=self._context)
        self._states = Polled(self._node, contract.JOINT_STATES_THROTTLE, depth=100)
        self._phases = Polled(self._node, contract.PHASE, qos_profile=contract.qos_latched())

    def first_tick_and_episode(self, began: float) -> dict[str, float]:
        """Seconds since ``began``."""
        found: dict[str, float] = {}
        stamps: set[tuple[int, int]] = set()
        while len(found) < 2:
            while (state := self._states.take()) is not None:
                stamps.add((state.header.stamp.sec, state.header.stamp.nanosec))
                if len(stamps) > 1:
                    found.setdefault('first_tick', round(time.monotonic() - began, 2))
            while (phase := self._phases.take()) is not None:
                if phase.data == 'teach':
                    found.setdefault('first_episode', round(time.monotonic() - began, 2))
            if time.monotonic() > began + GIVEN_UP_AFTER:
                raise TimeoutError(f'no first tick and episode within {GIVEN_UP_AFTER:.0f} s; seen: {found}')
            time.sleep(0.01)
        return found

    def __enter__(self) -> '_Graph':
        return self

    def __exit__(self, *_: object) -> None:
        self._node.destroy_node()
        self._context.try_shutdown()


def measure() -> dict[str, Any]:
    """``help_cpu_s`` by command and the largest of them; ``session_s``, medians over the rounds."""
    helps = help_cpu_s()
    rounds = [session_s() for _ in range(ROUNDS)]
    seconds = {name: [found[name] for found in rounds] for name in rounds[-1]}
    return {'help_cpu_s_max': max(helps.values()), 'help_cpu_s': helps,
            'session_s': {name: {'median': round(statistics.median(values), 2), 'min_max': [min(values), max(values)]}
                          for name, values in seconds.items()},
            'rounds': rounds}
