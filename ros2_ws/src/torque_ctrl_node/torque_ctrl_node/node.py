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

"""1 kHz computed-torque controller: answers every /joint_states with joint torques.

Sums the moments of human and agent, turns them into a wrench at the tray, and publishes
``tau_pd + J^T W_tr + tau_g`` on /effort_controller/commands, the applied moment on /target_wrench and its parts on
/human/applied_wrench and /agent/applied_wrench.
"""

import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.control.moments import sum_moments
from shared_control.control.sharing import PERSONS_WEIGHT, WAYS, Sharing
from shared_control.rates import CONTROL_PERIOD, POLICY_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.robot.tray import carrying
from shared_control_ros import contract
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import ParameterError, declare
from shared_control_ros.real_time import keep_loop_on_time
from shared_control_ros.robot_parameter import declare_robot
from shared_control_ros.runner import Stop, run
from shared_control_ros.serialized import stamp_of
from shared_control_ros.stamps import robot_time
from shared_control_ros.task_parameter import declare_task
from shared_control_ros.torque_command import TorqueBytes
from shared_control_ros.watchdog import Watchdog

from .applied_moments import AppliedMoments
from .joint_states import JointStateReader
from .safety import JOINTS_SECONDS, Safety
from .wrench_input import WrenchInput

TICKS_PER_POLL = 10
"""How often services are looked at and unchanged moments are published again."""
SILENCE = 0.1
"""Joint states that do not come for this long are waited for no more in this turn, s."""
LEAVE_SECONDS = 3.0
"""A controller that leaves brings the arm to rest within this, or leaves without, s."""


class TorqueCtrlNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('torque_ctrl_node')
        self._role = claim(node, 'controller')
        robot = declare_robot(node)
        gains = declare(node, 'gains', 'task', 'PD gains.', choices=tuple(robot.gains))
        task = declare_task(node, 'The task: along which axes moments count, and which tray the robot carries.')
        self._task_name = task.name
        robot = carrying(robot, task.scene)
        self._timeout = declare(
            node, 'command_timeout', 0.1, 'A wrench older than this counts as zero.', unit='s',
            minimum=0.02, maximum=1.0)
        limit = declare(
            node, 'moment_limit', float(task.limit.max()), 'Bound of the sum of both moments about each axis.',
            unit='N m', minimum=0.0, maximum=200.0)
        self._moment_limit = np.full(len(task.axes), limit)
        self._sharing = Sharing(
            declare(node, 'sharing', 'additive', 'What counts of the two moments.', choices=WAYS),
            declare(node, 'blend_weight', PERSONS_WEIGHT, "The person's weight with sharing 'blend'.", minimum=0.0,
                    maximum=1.0))
        try:
            self._sharing.check(len(task.axes))
        except ValueError as error:
            raise ParameterError(f'sharing: {error}') from error
        compensates = declare(
            node, 'robot_compensates_gravity', False, 'The robot adds gravity itself: leave it out of the command.')
        horizon = declare(
            node, 'prediction_horizon', CONTROL_PERIOD, 'Of the implicit PD: one tick in lockstep; 0.004 for a robot '
            'that runs freely and gets its torques some ticks late.', unit='s', minimum=0.001, maximum=0.02)
        wait_for = declare(
            node, 'wait_for', ['none'], 'Sources to wait for at every policy tick, for results that do not depend '
            'on timing.', choices=('none', 'human', 'agent'))
        enabled = declare(
            node, 'enabled', False, 'Send torques without being asked, as soon as the arm stands near the reference: '
            'for simulations. On a robot a person calls controller/enable.')

        self._controller = ComputedTorqueController(
            RobotModel(robot), task.axes, gains=gains, dt=CONTROL_PERIOD, horizon=horizon,
            robot_compensates_gravity=compensates)
        self._reader = JointStateReader(robot)
        self._joint_states = Polled(node, contract.JOINT_STATES, raw=True)
        self._human = WrenchInput(node, contract.HUMAN_WRENCH, task.axes, self._timeout, robot.base_frame)
        self._agent = WrenchInput(node, contract.AGENT_WRENCH, task.axes, self._timeout, robot.base_frame)
        sources = {'human': self._human, 'agent': self._agent}
        self._awaited = [source for name, source in sources.items() if name in wait_for]
        self._policy_period_ns = round(POLICY_PERIOD * 1e9)

        self._command = TorqueBytes(robot.dof)
        self._command_publisher = node.create_publisher(
            contract.EFFORT_COMMANDS.msg_type, contract.EFFORT_COMMANDS.name, contract.EFFORT_COMMANDS.qos)
        self._applied = AppliedMoments(node, task.axes, robot.base_frame)
        self._safety = Safety(node, robot, enabled, self._report, compensates)

        if self._safety.is_stopped or not enabled:
            node.get_logger().warning(self._safety.problem)

        self._diagnostics = Diagnostics(node, CONTROL_PERIOD, needs=self._joint_states)
        self._watchdog = Watchdog()
        self._background = Background(node)
        self._now_ns = self._answered_ns = 0
        self._heard = time.monotonic()
        self._q = robot.home
        self._ticks = 0

    def run(self, stop: Stop) -> None:
        """Answer joint states until told to stop."""
        keep_loop_on_time()
        while not stop.requested:
            message = self._joint_states.wait(SILENCE)
            if message is None:
                self._serve()
                self._diagnostics.skip()
            else:
                self._hear(message, stop)
            self._ticks += 1
            if self._ticks % TICKS_PER_POLL == 0:
                self._serve()
            if self._diagnostics.due():
                self._report()

    def _serve(self) -> None:
        self._background.poll()
        self._safety.hear()

    def _hear(self, message: bytes, stop: Stop) -> None:
        try:
            state = self._reader.read(message)
            now_ns = robot_time(stamp_of(message))
            before, self._q = self._q, state[0]  # a simulator that was reset at this stamp says the same again
            if now_ns == self._now_ns and not np.array_equal(before, self._q):
                raise ValueError('its stamp is that of the one before, but the joints have moved')
        except ValueError as error:
            self.node.get_logger().error(
                f'dropped a message on {self._joint_states.topic_name}: {error}', throttle_duration_sec=1.0)
            return
        # By both clocks: what lay in a queue while this process was stopped comes first, and is old.
        heard, now = self._heard, time.monotonic()
        if now - heard > JOINTS_SECONDS or now_ns - self._now_ns > JOINTS_SECONDS * 1e9:
            self._safety.see_again(state[0])
        self._heard, self._now_ns = now, now_ns
        if not self._safety.enabled:
            self._stand_by(now_ns, *state)
        if self._safety.enabled:
            self._answer(now_ns, *state, stop)

    def _answer(self, now_ns: int, q: np.ndarray, qd: np.ndarray, effort: np.ndarray, stop: Stop) -> None:
        if self._awaited and now_ns % self._policy_period_ns == 0:
            self._wait_for_sources(now_ns, stop)
            if not self._safety.enabled:
                return
        self._human.update(now_ns)
        self._agent.update(now_ns)
        human, agent = self._human.moment(now_ns), self._agent.moment(now_ns)
        agent, human = self._sharing.parts(agent, human)
        applied = sum_moments(agent, human, self._moment_limit)
        if self._send(self._controller.torque(q, qd, effort, applied), now_ns):
            self._diagnostics.tick()
            self._applied.publish(now_ns, applied, human, agent, self._ticks % TICKS_PER_POLL == 0)

    def _stand_by(self, now_ns: int, q: np.ndarray, qd: np.ndarray, effort: np.ndarray) -> None:
        """Disabled: bring the arm to rest if it has just been disabled, else send nothing."""
        self._safety.see(q)
        for source in (self._human, self._agent):
            source.update(now_ns)  # nobody enables what was sent before the robot's time ran back
        if self._safety.stopping_ticks:
            self._safety.stopping_ticks -= now_ns != self._answered_ns  # a repeated tick is none
            self._send(self._controller.damping_torque(q, qd, effort), now_ns)

    def _send(self, torque: np.ndarray, now_ns: int) -> bool:
        """Answer joint states of a stamp, unless the torque cannot be sent; whether it was."""
        self._command.torque[:] = torque
        try:
            self._command_publisher.publish(self._command.answer(now_ns))
        except ValueError as error:
            self.node.get_logger().error(
                f'nothing sent on {self._command_publisher.topic_name}: {error}', throttle_duration_sec=1.0)
            return False
        self._answered_ns = now_ns
        return True

    def _wait_for_sources(self, now_ns: int, stop: Stop) -> None:
        for source in self._awaited:
            while not source.wait_for_stamp(now_ns, 1.0) and self._safety.enabled and not stop.requested:
                self.node.get_logger().warning(f'waiting for {source.topic_name} (parameter wait_for)')
                self._watchdog.feed()
                self._serve()

    def _report(self) -> None:
        self._watchdog.feed()
        problems = {}
        if problem := self._safety.problem:  # first: a screen may cut the rest off
            problems[self._command_publisher.topic_name] = problem
        for source in (self._human, self._agent):
            if problem := source.problem(self._now_ns):
                problems[source.topic_name] = problem
        self._diagnostics.publish(
            problems, level=DiagnosticStatus.ERROR if self._safety.is_stopped else None, enabled=self._safety.enabled,
            enables_itself=self._safety.enables_itself, emergency_stop=self._safety.is_stopped,
            applied=self._applied.applied, task=self._task_name)

    def close(self) -> None:
        """Bring an arm that is moved to rest: without torques it would go on by its momentum until it brakes."""
        self._safety.begin_to_leave()
        deadline = time.monotonic() + LEAVE_SECONDS
        while self._safety.stopping_ticks and time.monotonic() < deadline:
            message = self._joint_states.wait(SILENCE)
            if message is None:
                break
            self._hear(message, Stop())
            self._serve()
        self._safety.leave()
        self._background.close()


def main() -> int:
    """Entry point."""
    return run(TorqueCtrlNode)


if __name__ == '__main__':
    raise SystemExit(main())
