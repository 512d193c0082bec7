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

"""Whether a person has paused the simulation."""

from rclpy.node import Node

from .. import contract
from ..fast_loop import Polled


class Pause:
    """What the simulator reports on /diagnostics: at once when it is paused or goes on, and once a second.

    It is known from there, and not from time that stands still: a slow machine is to take nobody's push away. A robot
    reports nothing of the kind, and is never paused.
    """

    def __init__(self, node: Node):
        self._reports = Polled(node, contract.DIAGNOSTICS, depth=50)
        self.is_on = False
        self.is_reported = False
        """Whether there is a simulator that reports it."""

    def update(self) -> None:
        """Take what was reported."""
        while (message := self._reports.take()) is not None:
            for status in message.status:
                for value in status.values:
                    if value.key == 'paused':
                        self.is_on, self.is_reported = value.value == 'True', True
