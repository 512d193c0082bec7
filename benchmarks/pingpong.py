"""Two bare rclpy processes that exchange the messages of a tick, JointState one way and torques the other.

This is what the middleware costs: the same messages, quality of service and way of receiving as on the graph, and no
physics, no controller and no other topic. It starts its own answering process and prints JSON.

    python benchmarks/pingpong.py --rounds 20000
    python benchmarks/pingpong.py --raw          # bytes made beforehand, as the nodes of the loop send and receive them
"""

import json
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from shared_control.command_line import script_parser
from shared_control.processes import leave_with_the_parent
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.torque_command import torque_command
from std_msgs.msg import Float64MultiArray


def _messages() -> tuple[JointState, Float64MultiArray]:
    robot = panda()
    zeros = [0.0] * robot.dof
    state = JointState(name=list(robot.joints), position=zeros, velocity=zeros, effort=zeros)
    state.header.frame_id = contract.BASE_FRAME
    return state, torque_command(zeros, 0)


def _publisher(node: Node, topic: contract.Topic) -> Callable[[Any], None]:
    publish: Callable[[Any], None] = node.create_publisher(topic.msg_type, topic.name, topic.qos).publish
    return publish


def answer(raw: bool) -> None:
    """Answer every JointState until the parent ends this process."""
    rclpy.init()
    node = Node('pong')
    states = Polled(node, contract.JOINT_STATES, raw=raw)
    publish = _publisher(node, contract.EFFORT_COMMANDS)
    _, command = _messages()
    sent = serialize_message(command) if raw else command
    while True:
        if states.wait(0.1) is not None:
            publish(sent)


def measure(rounds: int, raw: bool) -> list[float]:
    """Round trips in ms."""
    rclpy.init()
    node = Node('ping')
    commands = Polled(node, contract.EFFORT_COMMANDS, raw=raw)
    publish = _publisher(node, contract.JOINT_STATES)
    state, _ = _messages()
    sent = serialize_message(state) if raw else state
    times: list[float] = []
    while len(times) < rounds:
        started = time.perf_counter()
        publish(sent)
        if commands.wait(0.1) is not None:
            times.append((time.perf_counter() - started) * 1e3)
    node.destroy_node()
    rclpy.shutdown()
    return times[rounds // 10:]


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--answer', action='store_true', help='be the answering process')
    parser.add_argument('--raw', action='store_true', help='exchange bytes that were made beforehand')
    parser.add_argument('--rounds', type=int, default=20000, metavar='N', help='exchanges that are timed')
    args = parser.parse_args()
    if args.answer:
        answer(args.raw)
        return
    other = subprocess.Popen([sys.executable, __file__, '--answer', *['--raw'] * args.raw],
                             preexec_fn=leave_with_the_parent)
    try:
        p50, p99 = np.percentile(measure(args.rounds, args.raw), [50, 99])
    finally:
        other.kill()
        other.wait()
    print(json.dumps({'p50': round(float(p50), 4), 'p99': round(float(p99), 4)}))


if __name__ == '__main__':
    main()
