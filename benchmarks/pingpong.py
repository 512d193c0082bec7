"""Two bare rclpy processes that exchange the messages of a tick, JointState one way and torques the other.

This is what the middleware costs: the same messages, quality of service and way of receiving as the graph, and no
physics and no controller. It starts its own answering process and prints JSON.

    python benchmarks/pingpong.py --rounds 20000
"""

import json
import subprocess
import sys
import time

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState
from shared_control.command_line import script_parser
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from std_msgs.msg import Float64MultiArray


def answer() -> None:
    """Answer every JointState until the parent ends this process."""
    rclpy.init()
    node = Node('pong')
    states = Polled(node, contract.JOINT_STATES)
    publisher = node.create_publisher(Float64MultiArray, contract.EFFORT_COMMANDS.name, contract.EFFORT_COMMANDS.qos)
    command = Float64MultiArray(data=[0.0] * panda().dof)
    while True:
        if states.wait(0.1) is not None:
            publisher.publish(command)


def measure(rounds: int) -> list[float]:
    """Round trips in ms."""
    rclpy.init()
    node = Node('ping')
    commands = Polled(node, contract.EFFORT_COMMANDS)
    publisher = node.create_publisher(JointState, contract.JOINT_STATES.name, contract.JOINT_STATES.qos)
    zeros = [0.0] * panda().dof
    state = JointState(name=list(panda().joints), position=zeros, velocity=zeros, effort=zeros)
    state.header.frame_id = contract.BASE_FRAME
    times: list[float] = []
    while len(times) < rounds:
        started = time.perf_counter()
        publisher.publish(state)
        if commands.wait(0.1) is not None:
            times.append((time.perf_counter() - started) * 1e3)
    node.destroy_node()
    rclpy.shutdown()
    return times[rounds // 10:]


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--answer', action='store_true', help='be the answering process')
    parser.add_argument('--rounds', type=int, default=5000, metavar='N', help='exchanges that are timed')
    args = parser.parse_args()
    if args.answer:
        answer()
        return
    other = subprocess.Popen([sys.executable, __file__, '--answer'])
    try:
        p50, p99 = np.percentile(measure(args.rounds), [50, 99])
    finally:
        other.kill()
        other.wait()
    print(json.dumps({'p50': round(float(p50), 4), 'p99': round(float(p99), 4)}))


if __name__ == '__main__':
    main()
