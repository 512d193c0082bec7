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

"""Whether torques may be sent: enable, disable, and the emergency stop that wins over both."""

import math
import time
from collections.abc import Callable

import numpy as np
from rclpy.node import Node
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.spec import RobotSpec
from shared_control.robot.start import far_from_home
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from std_srvs.srv import SetBool, Trigger

from .robot_gravity import RobotGravity
from .stop_record import StopRecord

STOPPING_TICKS = round(0.5 / CONTROL_PERIOD)
"""How long the arm is brought to rest by damping before the torques end."""
JOINTS_SECONDS = 1.0
"""Joint positions that are older than this do not count, s."""


class Safety:
    """The controller's state, and the services and the topic that change it.

    Disabled, enabled, or stopped by the emergency stop, which no request but its own reset ends, and after which the
    controller is disabled. Whenever the torques are to end, the arm is first brought to rest. The emergency stop
    outlives the controller's process (:class:`StopRecord`).

    Args:
        node: the controller's node; serves ``controller/enable``, ``controller/emergency_stop`` and
            ``controller/reset_emergency_stop``, and subscribes to ``emergency_stop``.
        spec: the robot.
        enables_itself: as soon as nothing speaks against it, without being asked: for simulations.
        on_change: called after each change.
        compensates_gravity: the controller was told that the robot adds gravity itself.
    """

    def __init__(self, node: Node, spec: RobotSpec, enables_itself: bool, on_change: Callable[[], None],
                 compensates_gravity: bool):
        self._node = node
        self._spec = spec
        self._on_change = on_change
        self._gravity = RobotGravity(node, compensates_gravity)
        self._record = StopRecord(node.context.get_domain_id(), node.get_namespace())
        self.enabled = False
        """Whether torques are computed and sent."""
        self.stopping_ticks = 0
        """For so many more ticks the arm is to be brought to rest."""
        self._is_leaving = False
        self._q = spec.home
        self._q_seen = -math.inf
        self.is_stopped = self._record.is_on()
        """Whether the emergency stop is on."""
        if not self.is_stopped:
            self._record.forget()
        self._beside_a_simulator = enables_itself
        self.enables_itself = enables_itself and not self.is_stopped
        """Whether it will be enabled without being asked."""
        self._enable_name = node.resolve_service_name(contract.ENABLE_SERVICE)
        self._reset_name = node.resolve_service_name(contract.RESET_EMERGENCY_STOP_SERVICE)
        # However it is published: drivers of buttons may offer best effort, which a reliable subscription never gets.
        depth = contract.EMERGENCY_STOP.qos.depth
        self._stop_messages = (
            Polled(node, contract.EMERGENCY_STOP, depth, warns=False),
            Polled(node, contract.EMERGENCY_STOP, qos_profile=contract.qos_unreliable(depth)))
        node.create_service(SetBool, contract.ENABLE_SERVICE, self._on_enable)
        node.create_service(Trigger, contract.EMERGENCY_STOP_SERVICE, self._on_stop_request)
        node.create_service(Trigger, contract.RESET_EMERGENCY_STOP_SERVICE, self._on_reset)

    @property
    def problem(self) -> str:
        """Why no torques are sent; empty when they are."""
        if self.is_stopped:
            return f'emergency stop: {self._reset_name}, then {self._enable_name}, to go on'
        if self.enables_itself:
            return f'not enabled yet: {self._obstacle()}'
        return '' if self.enabled else f'disabled: {self._enable_name} to go on'

    def see(self, q: np.ndarray) -> None:
        """Joint positions while disabled, (n,), rad: they decide whether the controller may be enabled."""
        self._q = q
        self._q_seen = time.monotonic()
        if self.enables_itself:
            if obstacle := self._obstacle():
                self._node.get_logger().warning(f'not enabled yet: {obstacle}', throttle_duration_sec=5.0)
            else:
                self._enable()

    def see_again(self, q: np.ndarray) -> None:
        """Joint positions, (n,), rad, after none have come for longer than ``JOINTS_SECONDS``.

        A robot whose driver was started anew may stand elsewhere than where it was when somebody enabled the
        controller. A simulator's stands where it stood before a pause, and harms nobody.
        """
        if self._beside_a_simulator:
            return
        if self.enabled and (away := far_from_home(self._spec, q)):
            self.end_torques()
            self._changed(f'disabled: no usable joint states came for a while, and now {away}')
        if not self.enabled:
            self.stopping_ticks = 0  # what has had no torques for so long is at rest

    def hear(self) -> None:
        """Look whether somebody has published an emergency stop, or the robot how it is to be commanded.

        A false emergency stop means nothing: only the service ends one.
        """
        self._gravity.update()
        if self.enabled and self._gravity.obstacle:
            self.end_torques()
            self.stopping_ticks = 0  # what would bring the arm to rest holds its weight wrongly, too
            self._changed(f'disabled: {self._gravity.obstacle}')
        for messages in self._stop_messages:
            while (message := messages.take()) is not None:
                if message.data and not self.is_stopped:
                    self._emergency_stop()

    def end_torques(self) -> None:
        """Disable; the arm is to be brought to rest if it was moved."""
        self.enables_itself = False
        if self.enabled:
            self.enabled = False
            self.stopping_ticks = STOPPING_TICKS
            self._q_seen = -math.inf

    def begin_to_leave(self) -> None:
        """The controller is about to leave: the torques end, and nobody enables it any more."""
        self.end_torques()
        self._is_leaving = True

    def leave(self) -> None:
        """The controller leaves cleanly; an emergency stop that has come until now is kept."""
        self.hear()
        if self.is_stopped:
            self._record.leave()

    def _enable(self) -> None:
        self.enabled = True
        self.enables_itself = False
        self.stopping_ticks = 0

    def _obstacle(self) -> str:
        """What speaks against enabling now; empty when nothing does."""
        if self.is_stopped:
            return f'the emergency stop is on: call {self._reset_name} first'
        if self._is_leaving:
            return 'the controller is leaving'
        if time.monotonic() - self._q_seen > JOINTS_SECONDS:
            return f'no usable joint states on {self._node.resolve_topic_name(contract.JOINT_STATES.name)}'
        return self._gravity.obstacle or far_from_home(self._spec, self._q)

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data and not self.enabled:
            if obstacle := self._obstacle():
                response.success = False
                response.message = f'not enabled: {obstacle}'
                self._node.get_logger().error(response.message)
                return response
            self._enable()
        elif not request.data:
            self.end_torques()
        response.success = True
        response.message = (
            'enabled' if self.enabled else 'disabled: the arm is brought to rest, then no torques are sent')
        self._changed(response.message)
        return response

    def _on_stop_request(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._emergency_stop()
        response.success = True
        response.message = self.problem
        return response

    def _emergency_stop(self) -> None:
        self.is_stopped = True
        self.end_torques()
        try:
            self._record.keep()
        except OSError as error:
            self._node.get_logger().error(
                f'the emergency stop holds, but not beyond the life of this process: it cannot be kept ({error})')
        self._changed(self.problem)

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self.is_stopped
        response.message = 'the emergency stop is over; disabled' if self.is_stopped else 'there is no emergency stop'
        self.is_stopped = False
        self._record.forget()
        self._changed(response.message)
        return response

    def _changed(self, message: str) -> None:
        self._node.get_logger().warning(message)
        self._on_change()
