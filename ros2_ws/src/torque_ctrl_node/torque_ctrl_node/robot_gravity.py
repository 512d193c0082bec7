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

"""Whether the robot adds gravity itself, as it says on /diagnostics."""

from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.reports import values_of

_KEY = 'compensates_gravity'


class RobotGravity:
    """Compares what the robot says with what the controller was told; a robot that says nothing is trusted.

    Where the two differ the arm sinks, or rises, by its whole weight.

    Args:
        node: the controller's node.
        compensates: what it was told.
    """

    def __init__(self, node: Node, compensates: bool):
        self._reports = Polled(node, contract.DIAGNOSTICS, depth=50)
        self._told = compensates
        self.obstacle = ''
        """What speaks against sending torques; empty when nothing does."""

    def update(self) -> None:
        """Take what was reported."""
        while (message := self._reports.take()) is not None:
            for status in message.status:
                values = values_of(status)
                if _KEY in values:
                    self._compare(values[_KEY] == 'True')

    def _compare(self, compensates: bool) -> None:
        self.obstacle = '' if compensates == self._told else (
            f'the robot {"adds" if compensates else "does not add"} gravity itself: start the controller with '
            f'robot_compensates_gravity:={str(compensates).lower()}')
