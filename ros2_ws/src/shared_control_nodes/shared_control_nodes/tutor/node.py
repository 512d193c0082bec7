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

"""Simulated tutor: watches the tray and presses keys on /human/keys while the robot is taught.

Takes /ball, /joint_states_throttle, /human/target_wrench, /training/phase and /training/episode. It stands in for a
person: it sees late and inexactly, and presses keys. In any phase but ``teach`` it keeps its hands off.
"""

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.node import Node
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.seeds import episode_seed
from shared_control.teaching.tutors import TUTOR_NAMES, make_tutor, tutor_named
from shared_control_ros import contract
from shared_control_ros.ball_states import ball_state
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.joints import joint_positions
from shared_control_ros.parameters import declare
from shared_control_ros.robot_parameter import declare_robot
from shared_control_ros.runner import Stop, run
from shared_control_ros.stamps import to_ns
from shared_control_ros.task_parameter import declare_task
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.wrenches import moment_of

from .key_publisher import KeyPublisher

PERIOD_NS = round(POLICY_PERIOD * 1e9)


class SimTutorNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('sim_tutor_node')
        self._robot = declare_robot(node)
        name = declare(
            node, 'profile', 'expert', 'Who it is: a profile, or a family, of which the seed draws one.',
            choices=TUTOR_NAMES)
        self._seed = declare(
            node, 'seed', 0, 'Of errors of perception.', minimum=0, maximum=2**31 - 1)
        task = declare_task(node, 'The task: its axes and keys, and where the ball should be.')
        self._axes = task.axes
        self._tutor = make_tutor(tutor_named(name, self._seed), task, self._seed)
        self._balls = Polled(node, contract.BALL, depth=10)
        self._joints = Polled(node, contract.JOINT_STATES_THROTTLE)
        self._human = Polled(node, contract.HUMAN_WRENCH)
        self._lesson = Lesson(node)
        self._keys = KeyPublisher(node, task.keys)
        self._background = Background(node)
        self._diagnostics = Diagnostics(node, POLICY_PERIOD, needs=self._balls)
        self._stamp_ns = 0
        self._started_ns = 0
        self._q: np.ndarray | None = None
        self._held = np.zeros(len(task.axes))

    def run(self, stop: Stop) -> None:
        """Watch, and press keys, until told to stop."""
        while not stop.requested:
            ball = self._balls.wait(0.05)
            if ball is not None and to_ns(ball.header.stamp) % PERIOD_NS == 0:
                self._watch(ball)
            self._keys.update(self._stamp_ns)
            if ball is None:
                self._diagnostics.skip()
                self._background.poll()
            if self._diagnostics.due():
                self._background.poll()
                self._diagnostics.publish({}, phase=self._lesson.phase or '', presses=self._keys.presses)

    def _watch(self, ball: Odometry) -> None:
        """One look at the tray."""
        self._diagnostics.tick()
        self._follow_lesson(to_ns(ball.header.stamp))
        if (joints := self._joints.take()) is not None:
            try:
                self._q = joint_positions(joints, self._robot)
            except ValueError as error:
                self._complain(self._joints, str(error))
        if (wrench := self._human.take()) is not None:
            try:
                self._held = moment_of(wrench, self._axes, self._robot.base_frame)
            except ValueError as error:
                self._complain(self._human, str(error))
        if self._lesson.phase != 'teach' or self._q is None:
            return
        try:
            position, velocity = ball_state(ball, self._robot.base_frame)
        except ValueError as error:
            self._complain(self._balls, str(error))
            return
        picture = self._tutor.look(PlantState(self._q, position, velocity, *[self._held] * 3))
        key = self._tutor.key((self._stamp_ns - self._started_ns) * 1e-9, picture, self._held)
        if key is not None:
            self._keys.press(key, self._stamp_ns)

    def _complain(self, source: Polled, fault: str) -> None:
        self.node.get_logger().error(
            f'dropped a message on {source.topic_name}: {fault}', throttle_duration_sec=1.0)

    def _follow_lesson(self, stamp_ns: int) -> None:
        """Begin anew with every episode, and when the simulator was started anew."""
        if self._lesson.update() or stamp_ns < self._stamp_ns:
            episode = self._lesson.episode or 0
            self._tutor.reset(episode_seed(self._seed, episode), episode)
            self._started_ns = stamp_ns
        self._stamp_ns = stamp_ns

    def close(self) -> None:
        """Hands off."""
        self._keys.release(self._stamp_ns)
        self._background.close()


def main() -> int:
    """Entry point."""
    return run(SimTutorNode)


if __name__ == '__main__':
    raise SystemExit(main())
