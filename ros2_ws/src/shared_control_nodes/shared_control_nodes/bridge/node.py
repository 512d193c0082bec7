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

"""Bridge to a real Panda: wires panda-python's torque interface to /joint_states and /effort_controller/commands.

It refuses to move until a person calls robot/enable (SetBool), and ends the control when torques are silent, when the
arm reports an error, when the arm's time stands still and when it leaves. A control that cannot be ended ends with the
process, at once. robot/error_recovery (Trigger) leaves a reflex. A skeleton: see docs/how_to/real_panda.md.
"""

import os
import sys
import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.reflex import command_violation
from shared_control.robot.spec_file import panda
from shared_control.robot.start import far_from_home
from shared_control_ros import contract
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background
from shared_control_ros.joint_state_publisher import JointStatePublisher
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import ParameterError, declare
from shared_control_ros.robot_inputs import TorqueInput
from shared_control_ros.runner import Stop, run
from shared_control_ros.watchdog import Watchdog
from std_srvs.srv import SetBool, Trigger

from .arm import IDLE, Arm, ArmError, ArmState

ROUNDS_PER_POLL = 10
"""How often services are looked at, whether the arm's time goes on or not."""
POLL_SECONDS = 0.0002
"""How often the arm's state is looked at while it is under control."""
CONTROL_STANDSTILL = 0.5
"""panda-python goes on applying the last torque when this loop stands still; after this, s, the process ends, and the
control with it: the arm then stops by itself."""
STANDSTILL = "the arm's time stands still"
CLOCK_DRIFT = 0.05
"""How far the arm's clock may drift from this machine's before stamps are set anew, s."""


class PandaBridgeNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('panda_bridge_node')
        self._role = claim(node, 'robot')
        hostname = declare(node, 'hostname', '', "The arm's control box: host name or address.")
        self._timeout = declare(
            node, 'command_timeout', 0.1, 'Without torques for this long the control ends.', unit='s',
            minimum=0.01, maximum=1.0)
        if not hostname:
            raise ParameterError("parameter 'hostname' is missing: the arm's control box, -p hostname:=172.16.0.2")
        self._arm = Arm(hostname)
        self._enabled = False
        self._fault = ''
        self._command: np.ndarray | None = None
        self._command_time = 0.0
        self._joints = JointStatePublisher(node, panda())
        self._commands = TorqueInput(node, panda().dof, self._timeout)
        node.create_service(SetBool, contract.ROBOT_ENABLE_SERVICE, self._on_enable)
        node.create_service(Trigger, contract.ERROR_RECOVERY_SERVICE, self._on_error_recovery)
        self._enable_name = node.resolve_service_name(contract.ROBOT_ENABLE_SERVICE)
        self._background = Background(node)
        self._diagnostics = Diagnostics(node, CONTROL_PERIOD)
        self._watchdog = Watchdog()
        self._control_watchdog = Watchdog(max(CONTROL_STANDSTILL, 2.0 * self._timeout))
        self._rounds = 0
        self._lost: ArmError | None = None  # whoever asked to stop it is answered before the process ends
        self._stands_still = False
        self._state = self._arm.read()  # not earlier: making this node takes a while, by which stamps would be ahead
        self._last_tick = time.monotonic()
        self._set_clock()

    def _set_clock(self) -> None:
        """Stamps are whole milliseconds of the arm's clock, put beside this machine's."""
        self._start_ns = round(time.time_ns() / 1e6) * 1_000_000 - self._state.time_ms * 1_000_000

    def _follow_clock(self) -> None:
        """Only while the state is new: the arm may be silent for seconds while a control begins or ends."""
        drift = (time.time_ns() - self._stamp_ns()) * 1e-9
        if abs(drift) > CLOCK_DRIFT:
            self.node.get_logger().warning(f"stamps set anew: the arm's clock was {drift:.3f} s off this machine's")
            self._set_clock()

    def _stamp_ns(self) -> int:
        return self._start_ns + self._state.time_ms * 1_000_000

    def run(self, stop: Stop) -> None:
        """Pass states and torques on until told to stop."""
        while not stop.requested:
            (self._control_watchdog if self._enabled else self._watchdog).feed()
            self._hear()
            state = self._arm.read()
            if state.time_ms == self._state.time_ms:
                time.sleep(POLL_SECONDS)
                self._look_for_standstill()
            else:
                self._tell(state)
            if self._enabled:
                self._watch()
            self._rounds += 1
            if self._rounds % ROUNDS_PER_POLL == 0:
                self._background.poll()
            if self._lost is not None:
                raise self._lost
            if self._diagnostics.due():
                self._report()

    def _tell(self, state: ArmState) -> None:
        self._state = state
        if self._stands_still or self._diagnostics.due():
            self._follow_clock()
        self._joints.publish(self._stamp_ns(), state.q, state.qd, state.torque)
        self._diagnostics.tick()
        self._last_tick = time.monotonic()
        if self._stands_still:
            self._stands_still = False
            self.node.get_logger().warning("the arm's time goes on")
            self._report()

    def _look_for_standstill(self) -> None:
        """End the control of an arm of which nothing new is known."""
        if self._stands_still or time.monotonic() - self._last_tick <= self._timeout:
            return
        self._stands_still = True
        self._disable()
        self.node.get_logger().error(f'{STANDSTILL}: no new state for {self._timeout} s; disabled')
        self._report()

    def _hear(self) -> None:
        torque = self._commands.take_torque(self._stamp_ns())
        if torque is None:
            return
        self._command, self._command_time = torque, time.monotonic()
        if self._enabled:
            self._arm.command(torque)

    def _watch(self) -> None:
        """End the control when there is reason to."""
        if fault := self._arm.failure():
            self._disable()
            recovery = self.node.resolve_service_name(contract.ERROR_RECOVERY_SERVICE)
            self._fault = f'{fault}; to go on: {recovery}, then {self._enable_name}'
            self.node.get_logger().error(self._fault)
            self._report()
        elif self._silence() > self._timeout:
            self._disable()
            self.node.get_logger().warning(
                f'no torques on {self._commands.topic_name} for {self._timeout} s: disabled, the arm holds itself')
            self._report()

    def _silence(self) -> float:
        return time.monotonic() - self._command_time

    def _disable(self) -> None:
        """End the control.

        Raises:
            ArmError: it cannot be ended; so this process has to.
        """
        self._watchdog.feed()  # ending the control may take the arm a while
        self._enabled = False
        try:
            self._arm.stop()
        except ArmError as error:
            self._lost = error
            raise

    # -- services ----------------------------------------------------------------------------------------------------

    def _obstacle(self) -> str:
        """What speaks against moving now; empty when nothing does."""
        if self._stands_still:
            return STANDSTILL
        if self._state.mode != IDLE:
            return f'the arm is in mode {self._state.mode}, not {IDLE}'
        if self._command is None or self._silence() > self._timeout:
            return f'no torques on {self._commands.topic_name}: enable the controller first'
        # The controller looked when it was enabled; since then a hand may have moved the arm, which does not follow it.
        # Its torques do not show that: they begin near zero wherever the arm stands.
        if away := far_from_home(panda(), self._state.q):
            return away
        return command_violation(panda(), self._command, np.zeros(panda().dof), CONTROL_PERIOD)

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            if not request.data:
                self._disable()
            elif not self._enabled:
                if obstacle := self._obstacle():
                    raise RuntimeError(obstacle)
                self._arm.start()
                # While it began there was no new state, and so nothing to answer: that is no silence.
                self._command_time = self._last_tick = time.monotonic()
                self._enabled = True
            response.success = True
            response.message = 'enabled: the arm moves' if self._enabled else 'disabled: the arm holds itself'
        except (RuntimeError, ArmError) as error:
            response.success = False
            response.message = f'not {"enabled" if request.data else "disabled"}: {error}'
        self.node.get_logger().warning(response.message)
        return response

    def _on_error_recovery(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            self._disable()
            self._arm.recover()
            self._fault = ''
            response.success = True
            response.message = 'recovered; still disabled'
        except (RuntimeError, ArmError) as error:
            response.success = False
            response.message = str(error)
        self.node.get_logger().warning(response.message)
        return response

    # -- output ------------------------------------------------------------------------------------------------------

    def _report(self) -> None:
        problems = {}
        if fault := self._fault or (STANDSTILL if self._stands_still else ''):
            problems['robot'] = fault
        elif not self._enabled:
            problems[self._commands.topic_name] = f'disabled: {self._enable_name} to go on'
        self._diagnostics.publish(
            problems, level=DiagnosticStatus.ERROR if fault else None, mode=self._state.mode,
            enabled=self._enabled, compensates_gravity=True)

    def close(self) -> None:
        """End the control, and if it does not end, the process at once: taking leave would leave the arm to itself."""
        try:
            self._disable()
        except ArmError as error:
            print(f'error: {error}', file=sys.stderr, flush=True)
            os._exit(2)
        self._report()
        self._joints.flush()
        self._background.close()


def main() -> int:
    """Entry point."""
    return run(PandaBridgeNode)


if __name__ == '__main__':
    raise SystemExit(main())
