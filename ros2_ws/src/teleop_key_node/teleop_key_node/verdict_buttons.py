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

"""Buttons of a gamepad or the like that judge the last episode."""

from collections.abc import Mapping, Sequence

from rclpy.node import Node
from shared_control.verdict import Verdict
from shared_control_ros import contract
from shared_control_ros.parameters import ParameterError
from std_msgs.msg import String

from .sources import REMEMBERED


class VerdictButtons:
    """Finds presses (rising edges) of these buttons in the states of each source, and publishes verdicts.

    Args:
        node: the node that publishes.
        buttons: number of each verdict's button in the states; negative: it has none.
        taken: so many buttons, from 0, are the device's own.

    Raises:
        ParameterError: a button is the device's, or has two verdicts.
    """

    def __init__(self, node: Node, buttons: Mapping[Verdict, int], taken: int):
        used = [button for button in buttons.values() if button >= 0]
        for verdict, button in buttons.items():
            if 0 <= button < taken:
                raise ParameterError(f"parameter '{verdict}_button' is {button}, but buttons 0 to {taken - 1} are the "
                                     f'keys: choose {taken} or a higher one')
            if button >= 0 and used.count(button) > 1:
                raise ParameterError(f"parameter '{verdict}_button' is {button}, which has another verdict already")
        self._buttons = {verdict: button for verdict, button in buttons.items() if button >= 0}
        self._down: dict[str, set[Verdict]] = {}
        self._publisher = node.create_publisher(
            contract.HUMAN_VERDICT.msg_type, contract.HUMAN_VERDICT.name, contract.HUMAN_VERDICT.qos)

    def hear(self, source: str, buttons: Sequence[int]) -> None:
        """A state of one source. Buttons that are down when it is first heard are no presses."""
        down = {verdict for verdict, button in self._buttons.items() if button < len(buttons) and buttons[button]}
        for verdict in down - self._down.get(source, down):
            self._publisher.publish(String(data=str(verdict)))
        self._down.pop(source, None)
        self._down[source] = down
        if len(self._down) > REMEMBERED:  # not when one falls silent: drivers tell of changes alone
            del self._down[next(iter(self._down))]
