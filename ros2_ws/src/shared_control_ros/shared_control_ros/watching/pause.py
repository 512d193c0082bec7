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

"""Whether a person has paused the simulation, or ended the controller's torques."""

from rclpy.node import Node

from .. import contract
from ..fast_loop import Polled
from ..reports import values_of, waits_to_be_enabled


class Pause:
    """What simulator and controller report on /diagnostics: at once when that changes, and once a second.

    It is known from there, and not from time that stands still: a slow machine is to take nobody's push away. A robot
    reports nothing of the kind, and is never paused.
    """

    def __init__(self, node: Node):
        self._reports = Polled(node, contract.DIAGNOSTICS, depth=50)
        self.is_on = False
        self.is_reported = False
        """Whether there is a simulator that reports it."""
        self.controller_is_off = False
        """Whether the controller is stopped or disabled, and does not go on by itself."""

    def update(self) -> None:
        """Take what was reported."""
        while (message := self._reports.take()) is not None:
            for status in message.status:
                values = values_of(status)
                if 'paused' in values:
                    self.is_on, self.is_reported = values['paused'] == 'True', True
                if 'emergency_stop' in values:  # the bridge to a robot is enabled, too
                    self.controller_is_off = waits_to_be_enabled(values)
