"""The lockstep loop of the running graph, unpaced, beside the bare exchange of the same messages.

Simulator and controller run as they do in a session, with nobody else on the graph; the simulator times its ticks
itself (state published -> torque received -> physics stepped). The two alternate, so that a machine that grows slower
in the meantime slows both.
"""

import json
import signal
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.processes import node_environment, node_module

ROUNDS = 3
SECONDS = 8.0
DOMAINS = iter(range(80, 100))


def ping_pong() -> dict[str, float]:
    """p50 and p99 of the bare exchange, ms."""
    output = subprocess.run(
        [sys.executable, str(Path(__file__).with_name('pingpong.py'))], check=True, capture_output=True, text=True,
        env={**node_environment(), 'ROS_DOMAIN_ID': str(next(DOMAINS))}).stdout
    return json.loads(output.splitlines()[-1])


def ticks(seconds: float = SECONDS) -> dict[str, float]:
    """p50 and p99 of the graph's tick, ms, as the simulator reports them after ``seconds``."""
    domain = next(DOMAINS)
    environment = {**node_environment(), 'ROS_DOMAIN_ID': str(domain)}
    nodes = [subprocess.Popen([sys.executable, '-m', node_module(name), '--ros-args', '-p', *parameters],
                              env=environment, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
             for name, parameters in (('panda_sim_node', ['paced:=false']), ('torque_ctrl_node', ['enabled:=true']))]
    try:
        return _last_report(domain, seconds)
    finally:
        for node in nodes:
            node.send_signal(signal.SIGINT)
        for node in nodes:
            node.wait()


def _last_report(domain: int, seconds: float) -> dict[str, float]:
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = Node('bench', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    values: dict[str, Any] = {}

    def on_report(message: DiagnosticArray) -> None:
        if message.status[0].name == '/panda_sim_node':
            values.update({value.key: value.value for value in message.status[0].values})

    node.create_subscription(DiagnosticArray, contract.DIAGNOSTICS.name, on_report, contract.DIAGNOSTICS.qos)
    deadline = time.monotonic() + 60.0
    while float(values.get('running_seconds', 0)) < seconds or int(values.get('ticks', 0)) < 1000:
        if time.monotonic() > deadline:
            raise TimeoutError('the graph did not run within a minute')
        executor.spin_once(timeout_sec=0.2)
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()
    return {'p50': float(values['tick_p50_ms']), 'p99': float(values['tick_p99_ms'])}


def measure() -> dict[str, Any]:
    """``tick_ms``, ``pingpong_ms`` and their ``ratio``, medians over the rounds, with the rounds themselves."""
    rounds = []
    for _ in range(ROUNDS):
        bare, graph = ping_pong(), ticks()
        rounds.append({'pingpong_ms': bare, 'tick_ms': graph, 'ratio': round(graph['p50'] / bare['p50'], 3)})

    def median(name: str) -> dict[str, float]:
        return {key: round(statistics.median(r[name][key] for r in rounds), 4) for key in ('p50', 'p99')}

    ratios = [r['ratio'] for r in rounds]
    return {'tick_ms': median('tick_ms'), 'pingpong_ms': median('pingpong_ms'),
            'ratio': statistics.median(ratios), 'ratio_min_max': [min(ratios), max(ratios)], 'rounds': rounds}
