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

"""The campaign's own node on the graph of a session."""

import os
import signal
import time
from contextlib import suppress

from shared_control.contract import CONTROLLER_ENABLE, CONTROLLER_RESET
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

from ..live_session import Session
from ..nodes import Observer
from .messages import disturb
from .plan import Fault

STOPPED_S = 1.0
"""Time for an emergency stop to bring the arm to rest."""


class Graph:
    """The campaign's own node on the sessions' graph."""

    def __init__(self, domain: int):
        self.observer = Observer(domain)
        self._phases = self.observer.listen(contract.PHASE, 100)
        self._seen = 0
        self._heard: dict[str, Polled] = {}

    def disturb(self, topic: contract.Topic, fault: Fault) -> int:
        """Mix a stranger's messages into a topic; how many."""
        if topic.name not in self._heard:
            self._heard[topic.name] = Polled(self.observer.node, topic)
            self.serve_for(0.5)  # until the publishers have found it
        return disturb(self.observer.node, topic, self._heard[topic.name], fault.kind, fault.seconds, fault.seed,
                       self.serve)

    def serve(self) -> None:
        """Take what waits."""
        self.observer.take_all()

    def serve_for(self, seconds: float) -> None:
        """Take what comes for so long."""
        self.observer.spin_for(seconds)

    def wait_for_phase(self, phase: str, session: Session, timeout: float = 120.0) -> bool:
        """Wait for the beginning of ``phase``; False when the session ends or that does not come."""
        deadline = time.monotonic() + timeout
        while session.process.poll() is None and time.monotonic() < deadline:
            self.serve_for(0.02)
            fresh, self._seen = self._phases[self._seen:], len(self._phases)
            if any(message.data == phase for message in fresh):
                return True
        return False

    def wait_for_change(self, session: Session, timeout: float) -> bool:
        """Wait for the beginning of any phase, or for the session's end; whether either came."""
        deadline = time.monotonic() + timeout
        before = self._seen = len(self._phases)
        while time.monotonic() < deadline:
            if session.process.poll() is not None or len(self._phases) > before:
                return True
            self.serve_for(0.05)
        return False

    def emergency_stop(self, session: Session, controller: int) -> list[str]:
        """Stop, kill the controller, see that it stays stopped, and reset; what was wrong."""
        observer = self.observer
        publisher = observer.publisher(contract.EMERGENCY_STOP)
        observer.spin(lambda: publisher.get_subscription_count(), what='a subscriber of /emergency_stop')
        publisher.publish(Bool(data=True))
        observer.spin_for(STOPPED_S)
        with suppress(ProcessLookupError):
            os.kill(controller, signal.SIGKILL)
        observer.spin(lambda: session.node('torque_ctrl_node') not in (0, controller), 60.0, 'a new controller')
        commands = observer.listen(contract.EFFORT_COMMANDS)
        observer.spin(lambda: observer.node.count_publishers(contract.EFFORT_COMMANDS.name) > 0, 60.0, 'its commands')
        observer.spin_for(2 * STOPPED_S)
        wrong = [f'emergency stop: {len(commands)} torques after a restart of the controller'] if commands else []
        for service, name, request in ((Trigger, CONTROLLER_RESET.name, Trigger.Request()),
                                       (SetBool, CONTROLLER_ENABLE.name, SetBool.Request(data=True))):
            observer.call(service, name, request)
        observer.node.destroy_publisher(publisher)
        return wrong

    def close(self) -> None:
        """Leave."""
        self.observer.close()
