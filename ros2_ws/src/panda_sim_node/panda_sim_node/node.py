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

"""Simulator of a Panda with a tray and a ball: a robot on topics.

Publishes /joint_states (1 kHz), /ball and /clock (100 Hz), takes joint torques on /effort_controller/commands and
pushes at the tray on /disturbance. Services: simulator/reset (Trigger), simulator/pause and
simulator/rest (SetBool), simulator/set_parameters (SetParameters: seed).
"""

import time
from dataclasses import replace

import numpy as np
from rclpy.node import Node
from shared_control.plugins import WORLDS, load, names
from shared_control.rates import CONTROL_PERIOD, TICKS_PER_ACTION
from shared_control.scene import Ball
from shared_control.tasks.task import BallStarts
from shared_control.world import World
from shared_control_ros import contract
from shared_control_ros.ball_starts import follow_seed
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
from std_srvs.srv import SetBool, Trigger

from .tick_times import TickTimes

PERIOD_NS = round(CONTROL_PERIOD * 1e9)
REPEAT_AFTER = 0.1
"""A tick that nobody answers is published again after this, s."""
STANDS_STILL_AFTER = 1.0
"""A controller that has not answered for this long is away, s."""
LEARNER_LEFT_AFTER = 5.0
"""A learner for whom time stands still, and who has not been in the graph for this long, has left, s."""
LAG_GIVEN_UP = 0.25
"""A paced run that is this far behind the wall clock no longer tries to catch up, s."""


class PandaSimNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('panda_sim_node')
        self._role = claim(node, 'robot')
        robot = declare_robot(node)
        mode = declare(
            node, 'mode', 'lockstep', 'lockstep: a tick waits for its torque. free_running: a tick a millisecond, '
            'whatever arrives, as a robot does.', choices=('lockstep', 'free_running'))
        self._paced = declare(node, 'paced', True, 'Keep lockstep to real time; false: as fast as it goes.')
        seed = declare(
            node, 'seed', 0, 'Of the sequence of ball starts; setting it begins the sequence anew.',
            minimum=0, maximum=2**31 - 1, read_only=False)
        task = declare_task(node, 'The task: the tray on the flange, and where a ball is dropped.')
        self._task_name = task.name
        self._starts = BallStarts(task, seed)
        follow_seed(node, self._starts)
        physics = declare(node, 'physics', 'bullet', 'The physics.', choices=names(WORLDS))
        timeout = declare(
            node, 'command_timeout', 0.1, 'free_running: without a torque for this long the joints brake.',
            unit='s', minimum=0.002, maximum=10.0)
        ball = Ball(
            mass=declare(node, 'ball_mass', Ball.mass, 'Mass of the ball.', unit='kg', minimum=0.001, maximum=5.0),
            radius=declare(
                node, 'ball_radius', Ball.radius, 'Radius of the ball.', unit='m', minimum=0.005, maximum=0.05))

        self._advance = self._advance_lockstep if mode == 'lockstep' else self._advance_free
        self._world: World = load(WORLDS, physics)(replace(task.scene, ball=ball), CONTROL_PERIOD, robot)
        self._world.reset(self._starts.next())
        self._states = StatePublisher(node, self._world)
        self._timeout_ticks = round(timeout / CONTROL_PERIOD)
        self._commands = TorqueInput(node, robot.dof, timeout)
        self._pushes = PushInput(node, self._world, self._timeout_ticks)
        self._episode = EpisodeGuard(node)
        node.create_service(Trigger, contract.RESET_SERVICE, self._on_reset)
        node.create_service(SetBool, contract.PAUSE_SERVICE, self._on_pause)
        node.create_service(SetBool, contract.REST_SERVICE, self._on_rest)
        self._background = Background(node)
        self._diagnostics = Diagnostics(node, CONTROL_PERIOD)
        self._watchdog = Watchdog()

        self._tick = 0
        # Simulation time starts at the time of the day, at a multiple of the policy period.
        policy_period_ns = TICKS_PER_ACTION * PERIOD_NS
        self._start_ns = time.time_ns() // policy_period_ns * policy_period_ns
        self._paused = False  # by a person
        self._rests = False  # for the learner
        self._had_learner = 0.0
        """When there was one last while it rested, s of the monotonic clock."""
        self._times = TickTimes()
        self._running_seconds = 0.0
        self._missed = 0
        self._command: np.ndarray | None = None
        self._command_age = 0

    def run(self, stop: Stop) -> None:
        """Tick until told to stop."""
        began = self._deadline = time.monotonic()
        keep_loop_on_time()
        while not stop.requested:
            if self._tick % TICKS_PER_ACTION == 0:
                self._between_actions()
            if self._stands_still:
                self._background.spin_once(0.02)
                self._end_rest_of_nobody()
                self._diagnostics.skip()
                began = self._deadline = time.monotonic()
            else:
                self._advance(stop)
                now = time.monotonic()
                if self._tick > 1:  # the wait for the controller at the start is no running
                    self._running_seconds += now - began
                began = now
            if self._diagnostics.due():
                self._report()

    @property
    def _stands_still(self) -> bool:
        return self._paused or self._rests

    def _end_rest_of_nobody(self) -> None:
        """Let time go on when the learner has left, or was killed: people see no pause that they could end."""
        now = time.monotonic()
        if not self._rests or self._episode.has_learner:
            self._had_learner = now
        elif now - self._had_learner > LEARNER_LEFT_AFTER:
            self._rests = False
            self.node.get_logger().warning('the learner for whom time stood still has left: time goes on')

    def _between_actions(self) -> None:
        """Requests and disturbances are looked at here while time goes on, so that results can be repeated."""
        self._background.poll()
        self._pushes.update(self._tick)

    @property
    def _stamp_ns(self) -> int:
        return self._start_ns + self._tick * PERIOD_NS

    def _publish(self) -> None:
        self._states.publish(self._stamp_ns, self._world.effort)

    # -- lockstep --------------------------------------------------------------------------------------------------

    def _advance_lockstep(self, stop: Stop) -> None:
        if self._paced:
            self._pace()
        started = time.perf_counter()
        self._publish()
        torque = self._await_torque(stop)
        if torque is None:
            return
        self._world.step(self._world.spec.clamp_torque(torque))
        self._times.add(time.perf_counter() - started)
        self._diagnostics.tick()
        self._tick += 1

    def _await_torque(self, stop: Stop) -> np.ndarray | None:
        """The torque for this tick; None when the node is to stop or was paused meanwhile."""
        began = published = time.monotonic()
        while not (stop.requested or self._stands_still):
            message = self._commands.wait(REPEAT_AFTER)
            torque = None if message is None else self._commands.read(message, self._stamp_ns)
            if torque is not None:
                return torque
            now = time.monotonic()
            if message is None or now - published >= REPEAT_AFTER:  # unusable torques may come without end
                if now - began >= STANDS_STILL_AFTER:
                    self._stand_still(now - began)
                self._publish()
                published = now
        return None

    def _stand_still(self, waited: float) -> None:
        """Without a controller the node answers, at whatever tick, but time does not go on."""
        self.node.get_logger().warning(
            f'no torque on {self._commands.topic_name} for {waited:.1f} s: the simulation stands still until '
            'the controller answers', throttle_duration_sec=5.0)
        self._background.poll()
        if self._diagnostics.due():
            self._report()

    def _pace(self) -> None:
        self._deadline += CONTROL_PERIOD
        lag = time.monotonic() - self._deadline
        if lag < 0:
            time.sleep(-lag)
        elif lag > LAG_GIVEN_UP:
            self._deadline += lag

    # -- free running ----------------------------------------------------------------------------------------------

    def _advance_free(self, stop: Stop) -> None:
        self._pace()
        started = time.perf_counter()
        torque = self._commands.take_torque(self._stamp_ns)
        if torque is None:
            self._missed += 1
            self._command_age += 1
        else:
            self._command = self._world.spec.clamp_torque(torque)
            self._command_age = 0
        if self._command is None or self._command_age > self._timeout_ticks:
            self._world.step_braked()
        else:
            self._world.step(self._command)
        self._tick += 1
        self._publish()
        self._times.add(time.perf_counter() - started)
        self._diagnostics.tick()

    # -- services ---------------------------------------------------------------------------------------------------

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = self._episode.refusal()
        response.success = not response.message
        if not response.success:
            return response
        ball = self._starts.next()
        self._world.reset(ball)
        self._command = None
        self._tick += -self._tick % TICKS_PER_ACTION  # episodes start at policy ticks, also where a controller left
        response.message = f'ball dropped at x = {ball[0]:.4f} m'
        return response

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._paused = request.data
        self._report()  # at once: keys do not count in a pause
        response.success = True
        response.message = self._state
        return response

    def _on_rest(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._rests = request.data
        self._had_learner = time.monotonic()
        self._episode.rest(request.data)
        response.success = True
        response.message = self._state
        return response

    @property
    def _state(self) -> str:
        return 'paused' if self._paused else 'at rest for the learner' if self._rests else 'running'

    # -- output ----------------------------------------------------------------------------------------------------

    def _report(self) -> None:
        self._watchdog.feed()
        simulated = self._tick * CONTROL_PERIOD
        problems = {}
        if self._commands.publisher_count() == 0:
            problems[self._commands.topic_name] = 'no publisher'
        self._diagnostics.publish(
            problems, ticks=self._tick, tick_p50_ms=f'{self._times.quantile_ms(0.5):.3f}',
            tick_p99_ms=f'{self._times.quantile_ms(0.99):.3f}', late_ticks=self._times.late,
            running_seconds=f'{self._running_seconds:.3f}', simulated_seconds=f'{simulated:.3f}',
            missed_commands=self._missed, paused=self._paused, at_rest=self._rests, compensates_gravity=False,
            task=self._task_name)

    def close(self) -> None:
        """Publish the figures of the whole run and free the physics server."""
        self._report()
        self._states.flush()
        self._background.close()
        self._world.close()


def main() -> int:
    """Entry point."""
    return run(PandaSimNode)


if __name__ == '__main__':
    raise SystemExit(main())
