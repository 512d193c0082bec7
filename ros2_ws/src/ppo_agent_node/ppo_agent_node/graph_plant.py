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

"""The plant of an environment, reached through the topics of the graph."""

import time
from collections.abc import Callable

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from shared_control.plant import PlantInterrupted, PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.ball_states import ball_state
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.joints import joint_positions
from shared_control_ros.serialized import stamp_of
from shared_control_ros.stamps import set_ns, to_ns
from shared_control_ros.wrenches import base_wrench, set_moment

from .applied_moment import AppliedMoment
from .simulator import Simulator

PERIOD_NS = round(POLICY_PERIOD * 1e9)
GAP_NS = 1_000_000_000
"""An episode may miss as much when the machine is busy, not more."""
JOINTS_SECONDS = 0.5
"""How long the joints of a ball's stamp may be overdue, s; they are sent before it. Applied moments likewise."""


class GraphPlant:
    """See :class:`shared_control.plant.Plant`.

    Policy ticks are the stamps of ``/ball`` that are multiples of 20 ms. The state at such a tick is that ball and the
    ``/joint_states_throttle`` of the same stamp; the moment that answers it carries its stamp, too.

    A graph that stands still (paused by a person, or without its controller) is waited for: its time stands still,
    too. When the simulator was started anew, or the controller applies nothing while time goes on, the episode is void:
    :class:`PlantInterrupted`.

    Args:
        node: the agent's node.
        axes: of the task.
        background: serves it.
        attend: called at every step and again and again while waiting; may raise to end the episode.
        robot: the robot; the Panda when not given.
    """

    def __init__(self, node: Node, axes: tuple[int, ...], background: Background, attend: Callable[[], None],
                 robot: RobotSpec | None = None):
        self._axes = axes
        self.spec = panda() if robot is None else robot
        self._node = node
        self._attend = attend
        self._simulator = Simulator(node, background)
        self._balls = Polled(node, contract.BALL, depth=contract.BALL.qos.depth)
        self._joints = Polled(
            node, contract.JOINT_STATES_THROTTLE, depth=contract.JOINT_STATES_THROTTLE.qos.depth, raw=True)
        self._moments = [AppliedMoment(node, topic, axes, self.spec.base_frame) for topic in (
            contract.HUMAN_APPLIED, contract.AGENT_APPLIED, contract.APPLIED_WRENCH)]
        self._publisher = node.create_publisher(
            contract.AGENT_WRENCH.msg_type, contract.AGENT_WRENCH.name, contract.AGENT_WRENCH.qos)
        self._wrench = base_wrench(self.spec.base_frame)
        self._stamp_ns = 0
        self._began_ns = 0
        """The first tick of the episode."""
        self._nothing_applied = False
        """Whether the last episode was void because the controller applied nothing."""
        self._last_number = 0
        self.late_steps = 0
        """Policy ticks that came and went while the agent was busy."""

    def wait_until_up(self) -> None:
        """Wait until the simulator and the controller are there, and apply moments if they were seen not to."""
        while not (self._simulator.is_there() and self._moments[0].publisher_count()):
            self._node.get_logger().info(
                'waiting for the simulator and the controller', throttle_duration_sec=5.0)
            time.sleep(0.1)
            self._attend()
        applied = self._moments[-1]
        while self._nothing_applied and not applied.has_come():
            self._node.get_logger().info(
                f'waiting for the controller: nothing comes on {applied.topic_name}', throttle_duration_sec=5.0)
            time.sleep(0.1)
            self._answer_with_zero()
        self._nothing_applied = False

    def reset(self, seed: int | None) -> PlantState:
        """See :meth:`Plant.reset`."""
        stands_still = self._rest()
        self._simulator.reset(seed, self._attend)
        self._balls.clear()
        if stands_still:  # the tick at which it does so is sent again
            self._joints.clear()
        # A robot's time goes on: joints of a ball that a camera has yet to tell of wait already.
        for moment in self._moments:
            moment.clear()
        self._last_number = 0
        self._simulator.rest(False, self._attend)
        ball = self._next_ball()
        self._began_ns = to_ns(ball.header.stamp)
        return self._read(ball)

    def advance(self, agent: np.ndarray) -> PlantState:
        """See :meth:`Plant.advance`."""
        self._publish(agent)
        ball = self._next_ball()
        step_ns = to_ns(ball.header.stamp) - self._stamp_ns
        if step_ns <= 0:
            raise PlantInterrupted(f'the stamps on {self._balls.topic_name} went back by {-step_ns * 1e-9:.3f} s')
        if step_ns > GAP_NS:
            raise PlantInterrupted(f'nothing on {self._balls.topic_name} for {step_ns * 1e-9:.1f} s of its time: this '
                                   'machine is too busy')
        self.late_steps += step_ns // PERIOD_NS - 1
        return self._read(ball)

    def rest(self) -> None:
        """Ask for nothing, and stop time."""
        self._rest()

    def _rest(self) -> bool:
        """See :meth:`rest`; whether time stands still."""
        self._answer_with_zero()
        return self._simulator.rest(True, self._answer_with_zero)

    def _answer_with_zero(self) -> None:
        """Time goes on until the rest begins, and a controller that waits for an answer must have one."""
        while (ball := self._balls.take()) is not None:
            self._stamp_ns = to_ns(ball.header.stamp)
        if self._stamp_ns:
            self._publish(np.zeros(len(self._axes)))
        self._attend()

    def _publish(self, agent: np.ndarray) -> None:
        """The agent's moment, (1,), N m, as the answer to the last observation."""
        set_ns(self._wrench.header.stamp, self._stamp_ns)
        set_moment(self._wrench, agent, self._axes)
        self._publisher.publish(self._wrench)

    def _next_ball(self) -> Odometry:
        """The ball at the next policy tick; at the last one, when some went by."""
        newest = None
        silent_since = time.monotonic()
        while newest is None:
            self._attend()
            self._balls.wait_ready(0.05)
            while (taken := self._balls.take_with_info()) is not None:
                ball, info = taken
                self._check_sender(info['publication_sequence_number'])
                stamp_ns = to_ns(ball.header.stamp)
                if stamp_ns % PERIOD_NS == 0 and stamp_ns != self._stamp_ns and self._is_usable(ball):
                    newest = ball
            if time.monotonic() - silent_since > 1.0:
                self._node.get_logger().info(
                    f'{self._balls.topic_name} has been silent for {time.monotonic() - silent_since:.0f} s: paused, '
                    'waiting for the controller, or out of reach', throttle_duration_sec=5.0)
        return newest

    def _check_sender(self, number: int) -> None:
        """A publisher numbers its messages from 1."""
        if number <= self._last_number:
            raise PlantInterrupted(f'{self._balls.topic_name} has a new publisher: the simulator was started anew')
        self._last_number = number

    def _is_usable(self, ball: Odometry) -> bool:
        try:
            ball_state(ball, self.spec.base_frame)
        except ValueError as error:
            self._node.get_logger().error(
                f'dropped a message on {self._balls.topic_name}: {error}', throttle_duration_sec=1.0)
            return False
        return True

    def _read(self, ball: Odometry) -> PlantState:
        """The state at the tick of ``ball``, with the moments that counted just before it."""
        self._stamp_ns = to_ns(ball.header.stamp)
        joints = self._joints_at(self._stamp_ns)
        self._insist_on_moments()
        position, velocity = ball.pose.pose.position, ball.twist.twist.linear
        return PlantState(
            joints, (position.x, position.y, position.z),
            (velocity.x, velocity.y, velocity.z), *(moment.before(self._stamp_ns) for moment in self._moments))

    def _insist_on_moments(self) -> None:
        """A learner is taught nothing by a robot that nobody moves."""
        applied = self._moments[-1]
        deadline = time.monotonic() + JOINTS_SECONDS
        while True:
            applied.before(self._stamp_ns)
            silent_ns = self._stamp_ns - max(applied.newest_ns, self._began_ns)
            if silent_ns <= GAP_NS:
                return
            if time.monotonic() > deadline:
                break
            time.sleep(0.01)  # a busy machine brings them late
        self._nothing_applied = True
        raise PlantInterrupted(
            f"nothing on {applied.topic_name} for {silent_ns * 1e-9:.1f} s of the robot's time: the controller is "
            f'disabled or stopped, {self._node.resolve_service_name(contract.ENABLE_SERVICE)} to go on')

    def _joints_at(self, stamp_ns: int) -> np.ndarray:
        """Joint positions at a tick, (n,), rad."""
        deadline = time.monotonic() + JOINTS_SECONDS
        while time.monotonic() < deadline:
            serialized = self._joints.take()
            if serialized is None:
                self._joints.wait_ready(0.05)
            elif stamp_of(serialized) == stamp_ns:
                try:
                    return joint_positions(deserialize_message(serialized, contract.JOINT_STATES.msg_type), self.spec)
                except ValueError as error:
                    raise PlantInterrupted(f'{self._joints.topic_name}: {error}') from error
        raise PlantInterrupted(f'no {self._joints.topic_name} within {JOINTS_SECONDS:g} s of '
                               f'{self._balls.topic_name}: this machine is too busy')

    def close(self) -> None:
        """Leave no moment behind."""
        if self._stamp_ns:
            self._publish(np.zeros(len(self._axes)))
            self._publisher.wait_for_all_acked(Duration(nanoseconds=200_000_000))
