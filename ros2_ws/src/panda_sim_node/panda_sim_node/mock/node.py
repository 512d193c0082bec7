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

"""Mock of an effort-controlled Panda with tray and ball: the topics of a real robot and its behaviour, simulated.

Its clock runs freely (wall time, no /clock), its ticks jitter, it loses commands, carries its own weight, stops by
itself when a limit is violated, and recovers when asked to. Services: robot/enable (SetBool; it begins enabled),
robot/error_recovery (Trigger), simulator/reset (Trigger), simulator/set_parameters (SetParameters: seed),
simulator/pause and simulator/rest (SetBool, refused: a robot's time does not stand still).
"""

import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from shared_control.plugins import WORLDS, load, names
from shared_control.rates import CONTROL_PERIOD, TICKS_PER_ACTION
from shared_control.tasks.task import BallStarts
from shared_control.world import World
from shared_control_ros import contract
from shared_control_ros.ball_starts import follow_seed
from shared_control_ros.clock_steps import ClockSteps, in_words
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.episode_guard import EpisodeGuard
from shared_control_ros.fast_loop import Background
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import declare
from shared_control_ros.real_time import keep_loop_on_time
from shared_control_ros.robot_inputs import PushInput, TorqueInput
from shared_control_ros.robot_parameter import declare_robot
from shared_control_ros.runner import Stop, run
from shared_control_ros.state_publisher import StatePublisher
from shared_control_ros.task_parameter import declare_task
from shared_control_ros.watchdog import Watchdog
from shared_control_sim.effort_arm import EffortPanda, Mode
from std_srvs.srv import SetBool, Trigger

PERIOD_NS = round(CONTROL_PERIOD * 1e9)
POLICY_PERIOD_NS = TICKS_PER_ACTION * PERIOD_NS
LAG_GIVEN_UP = 0.25
"""A mock that is this far behind no longer tries to catch up; by the wall clock it leaves the missed time out, s."""


class MockPandaNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('mock_panda_node')
        self._role = claim(node, 'robot')
        robot = declare_robot(node)
        self._jitter = declare(
            node, 'jitter', 0.0005, 'A tick comes up to so much early or late.', unit='s', minimum=0.0, maximum=0.01)
        self._drop_rate = declare(
            node, 'drop_rate', 0.01, 'Share of the commands that get lost.', minimum=0.0, maximum=1.0)
        limit_rate = declare(
            node, 'limit_rate', True, "Approach a command that is too far from the last one, as libfranka's option "
            'of that name does; false: it makes the robot stop.')
        timeout = declare(
            node, 'command_timeout', 0.1, 'Without a command for this long the control ends and the joints brake.',
            unit='s', minimum=0.002, maximum=10.0)
        seed = declare(
            node, 'seed', 0, 'Of ball starts, jitter and losses; setting it begins the ball starts anew.',
            minimum=0, maximum=2**31 - 1, read_only=False)
        task = declare_task(node, 'The task: the tray on the flange, and where a ball is dropped.')
        physics = declare(node, 'physics', 'bullet', 'What it is inside.', choices=names(WORLDS))
        self._task_name = task.name
        self._starts = BallStarts(task, seed)
        follow_seed(node, self._starts)
        pace = declare(
            node, 'pace', 1.0, "Of the robot's clock against the wall clock. Below 1, for a machine that is too slow "
            'for 1 kHz, it publishes /clock: start the other nodes with use_sim_time.', minimum=0.01, maximum=1.0)
        self._period = CONTROL_PERIOD / pace
        self._has_clock = pace < 1.0

        self._random = np.random.default_rng(seed)
        world: World = load(WORLDS, physics)(task.scene, CONTROL_PERIOD, robot)
        world.reset(self._starts.next())
        self._robot = EffortPanda(world, timeout, limit_rate)
        self._states = StatePublisher(node, world, with_clock=self._has_clock)
        self._commands = TorqueInput(node, world.spec.dof, timeout)
        self._pushes = PushInput(node, world, round(timeout / CONTROL_PERIOD))
        node.create_service(SetBool, contract.ROBOT_ENABLE_SERVICE, self._on_enable)
        node.create_service(Trigger, contract.ERROR_RECOVERY_SERVICE, self._on_error_recovery)
        self._episode = EpisodeGuard(node)
        node.create_service(Trigger, contract.RESET_SERVICE, self._on_reset)
        node.create_service(SetBool, contract.PAUSE_SERVICE, self._on_pause)
        node.create_service(SetBool, contract.REST_SERVICE, self._on_rest)
        self._background = Background(node)
        self._diagnostics = Diagnostics(node, self._period)
        self._watchdog = Watchdog()

        self._tick = 0
        self._enabled = True
        self._reflexes = 0
        self._dropped = 0

    def run(self, stop: Stop) -> None:
        """Tick until told to stop."""
        keep_loop_on_time()
        # The robot's clock: stamps are whole milliseconds, and policy ticks are multiples of 20 ms.
        self._start_ns = time.time_ns() // POLICY_PERIOD_NS * POLICY_PERIOD_NS
        self._clock_steps = ClockSteps()
        self._due = time.monotonic()
        while not stop.requested:
            self._wait_for_tick()
            mode = self._robot.mode
            if self._tick % TICKS_PER_ACTION == 0:
                self._background.poll()
                self._pushes.update(self._tick)
            self._robot.tick(self._take_command())
            self._tick += 1
            self._states.publish(self._stamp_ns, self._robot.torque)
            self._diagnostics.tick()
            if self._robot.mode is not mode:
                self._on_mode()
            if self._diagnostics.due():
                self._follow_clock_of_the_day()
                self._report()

    def _follow_clock_of_the_day(self) -> None:
        """As the bridge does: others stamp by that clock, and their moments would count no more after it was set."""
        step = self._clock_steps.new()
        if step and not self._has_clock:
            self._start_ns += round(step * 1e9 / POLICY_PERIOD_NS) * POLICY_PERIOD_NS
            self.node.get_logger().warning(f'stamps set anew: {in_words(step)}')

    @property
    def _stamp_ns(self) -> int:
        return self._start_ns + self._tick * PERIOD_NS

    def _wait_for_tick(self) -> None:
        self._due += self._period
        late = time.monotonic() - self._due
        if late > LAG_GIVEN_UP:
            actions = round(late / (TICKS_PER_ACTION * self._period))
            self._due += actions * TICKS_PER_ACTION * self._period
            if not self._has_clock:
                self._start_ns += actions * POLICY_PERIOD_NS
                self.node.get_logger().warning(
                    f'this machine is too slow: {late:.2f} s are left out (see parameter pace)',
                    throttle_duration_sec=1.0)
        wait = self._due - time.monotonic() + self._random.uniform(-self._jitter, self._jitter)
        if wait > 0.0:
            time.sleep(wait)

    def _take_command(self) -> np.ndarray | None:
        torque = self._commands.take_torque(self._stamp_ns)
        if not self._enabled:
            return None
        if torque is not None and self._random.random() < self._drop_rate:
            self._dropped += 1
            return None
        return torque

    # -- services ----------------------------------------------------------------------------------------------------

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data and self._robot.mode is Mode.REFLEX:
            response.success = False
            response.message = f'not enabled: {self._fault()}'
            return response
        self._enabled = request.data
        if not self._enabled:
            self._robot.stop()
        response.success = True
        response.message = ('enabled: the next torques move the arm' if self._enabled else
                            'disabled: the brakes hold the arm')
        return response

    def _on_error_recovery(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._robot.recover()
        response.message = 'recovered: the next torques move the arm' if response.success else 'there is no error'
        return response

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = self._episode.refusal()
        response.success = not response.message
        if not response.success:
            return response
        ball = self._starts.next()
        self._robot.reset(ball)
        response.message = f'arm put back, ball dropped at x = {ball[0]:.4f} m'
        return response

    def _on_rest(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._episode.rest(request.data)
        return self._on_pause(request, response)

    def _on_pause(self, _: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = False
        response.message = "a robot's time does not stand still"
        return response

    # -- output ------------------------------------------------------------------------------------------------------

    def _on_mode(self) -> None:
        if self._robot.mode is Mode.REFLEX:
            self._reflexes += 1
            self.node.get_logger().error(self._fault())
        else:
            self.node.get_logger().info(f'mode: {self._robot.mode.value}')
        self._report()

    def _fault(self) -> str:
        recovery = self.node.resolve_service_name(contract.ERROR_RECOVERY_SERVICE)
        return f'reflex stop: {self._robot.fault}; to go on: {recovery}'

    def _report(self) -> None:
        self._watchdog.feed()
        mode = self._robot.mode
        problems = {}
        if mode is Mode.REFLEX:
            problems['robot'] = self._fault()
        elif not self._enabled:
            problems[self._commands.topic_name] = (
                f'disabled: {self.node.resolve_service_name(contract.ROBOT_ENABLE_SERVICE)} to go on')
        elif mode is Mode.IDLE:
            problems[self._commands.topic_name] = 'no torques: held by the brakes'
        self._diagnostics.publish(
            problems, level=DiagnosticStatus.ERROR if mode is Mode.REFLEX else None, mode=mode.value,
            reflexes=self._reflexes, dropped_commands=self._dropped, limited_ticks=self._robot.limited_ticks,
            ticks=self._tick, compensates_gravity=True, task=self._task_name)

    def close(self) -> None:
        """Publish the figures of the whole run and free the physics server."""
        self._report()
        self._states.flush()
        self._background.close()
        self._robot.world.close()


def main() -> int:
    """Entry point."""
    return run(MockPandaNode)


if __name__ == '__main__':
    raise SystemExit(main())
