"""The lockstep loop of the running graph, unpaced, beside the bare exchange of the same messages.

Simulator and controller run with nobody else on the graph; the simulator times its ticks itself (state published ->
torque received -> physics stepped). All processes run on the core that a session gives to the loop, since where the
kernel places two processes changes the times of either by half. The two alternate, so that a machine that grows slower
in the meantime slows both.
"""

import json
import os
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from shared_control.processes import leave_with_the_parent
from shared_control_ros import contract
from shared_control_ros.processes import node_module
from shared_control_ros.reports import values_of
from shared_control_testing.nodes import free_domain

ROUNDS = 7
SECONDS = 6.0
LOOP = {'panda_sim_node': ['paced:=false'], 'torque_ctrl_node': ['enabled:=true']}
"""The nodes of the loop, and their parameters."""


def to_the_loops_core() -> None:
    """Keep this process on the core that a session gives to the loop, and let it end with its parent."""
    leave_with_the_parent()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def ping_pong(*options: str) -> dict[str, float]:
    """p50 and p99 of the bare exchange, ms."""
    script = Path(__file__).with_name('pingpong.py')
    with free_domain():
        output = subprocess.run([sys.executable, str(script), *options], check=True, capture_output=True, text=True,
                                preexec_fn=to_the_loops_core).stdout
    return json.loads(output.splitlines()[-1])


def ticks(task: str) -> dict[str, float]:
    """p50 and p99 of the graph's tick, ms, as the simulator reports them after some seconds of a task."""
    with loop(task=task) as (domain, _):
        values = last_report(domain, SECONDS)
    return {'p50': float(values['tick_p50_ms']), 'p99': float(values['tick_p99_ms'])}


@contextmanager
def loop(python: dict[str, list[str]] | None = None, task: str = 'balance') -> Iterator[tuple[int, int]]:
    """The nodes of the loop, on its core; gives their domain, and the process of the first, the simulator.

    Args:
        python: what Python is called with for each; as they are installed when not given.
        task: of both.
    """
    python = python or {name: ['-m', node_module(name)] for name in LOOP}
    with free_domain() as domain:
        nodes = [subprocess.Popen(
            [sys.executable, *python[name], '--ros-args', '-p', f'task:={task}', '-p', *parameters],
            stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, preexec_fn=to_the_loops_core)
            for name, parameters in LOOP.items()]
        try:
            yield domain, nodes[0].pid
        finally:
            for node in nodes:
                node.send_signal(signal.SIGINT)
            for node in nodes:
                node.wait()


def last_report(domain: int, seconds: float, readers: int = 1) -> dict[str, Any]:
    """What the simulator has just reported, once it has run for ``seconds`` and so many read its joints."""
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = Node('bench', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    values: dict[str, Any] = {}

    def on_report(message: DiagnosticArray) -> None:
        if message.status[0].name == '/panda_sim_node':
            values.update(values_of(message.status[0]))

    node.create_subscription(DiagnosticArray, contract.DIAGNOSTICS.name, on_report, contract.DIAGNOSTICS.qos)
    deadline = time.monotonic() + 180.0
    while float(values.get('running_seconds', 0)) < seconds or int(values.get('ticks', 0)) < 1000:
        if node.count_subscribers(contract.JOINT_STATES.name) < readers:
            values.clear()
        if time.monotonic() > deadline:
            raise TimeoutError('the graph did not run within three minutes')
        executor.spin_once(timeout_sec=0.2)
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()
    return values


def measure() -> dict[str, Any]:
    """``tick_ms``, ``pingpong_ms`` and their ``ratio``, medians over the rounds, with the rounds themselves; the same
    for the exchange of bytes made beforehand (``raw``), which is what the nodes of the loop do, and for a tick with two
    axes (``plate``)."""
    rounds = []
    for _ in range(ROUNDS):
        bare, raw, tick, plate = ping_pong(), ping_pong('--raw'), ticks('balance'), ticks('plate')
        rounds.append({'pingpong_ms': bare, 'pingpong_raw_ms': raw, 'tick_ms': tick, 'tick_plate_ms': plate,
                       'ratio': round(tick['p50'] / bare['p50'], 3), 'ratio_raw': round(tick['p50'] / raw['p50'], 3),
                       'ratio_plate': round(plate['p50'] / bare['p50'], 3)})

    def median(name: str) -> dict[str, float]:
        return {key: round(statistics.median(r[name][key] for r in rounds), 4) for key in ('p50', 'p99')}

    figures: dict[str, Any] = {
        name: median(name) for name in ('tick_ms', 'tick_plate_ms', 'pingpong_ms', 'pingpong_raw_ms')}
    for name in ('ratio', 'ratio_raw', 'ratio_plate'):
        ratios = [r[name] for r in rounds]
        figures |= {name: statistics.median(ratios), f'{name}_min_max': [min(ratios), max(ratios)]}
    return {**figures, 'rounds': rounds}
