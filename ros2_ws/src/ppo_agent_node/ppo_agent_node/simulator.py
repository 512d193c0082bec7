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

"""The services of a simulator, called one after the other."""

import time
from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control.plant import PlantInterrupted
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from std_srvs.srv import SetBool, Trigger

ANSWER_SECONDS = 3.0
"""A simulator that does not answer for this long is asked again: it may have been restarted meanwhile."""


class Simulator:
    """Rests, resets and seeds the simulator; each call waits until that is done, however long it takes.

    ``attend`` is called again and again meanwhile; it may raise to give up.

    Args:
        node: the node that calls.
        background: serves its answers.
    """

    def __init__(self, node: Node, background: Background):
        self._node = node
        self._background = background
        self._rest = node.create_client(SetBool, contract.REST_SERVICE)
        self._reset = node.create_client(Trigger, contract.RESET_SERVICE)
        self._seed = node.create_client(SetParameters, contract.SEED_SERVICE)

    def rest(self, rests: bool, attend: Callable[[], None]) -> bool:
        """Stop time, or let it go on, unless a person has paused it; whether that was done.

        A robot refuses: its time goes on all the same.
        """
        answer = self._call(self._rest, SetBool.Request(data=rests), attend)
        if not answer.success:
            self._node.get_logger().info(
                f'{self._rest.service_name}: {answer.message or "refused"}', throttle_duration_sec=60.0)
        return answer.success

    def reset(self, seed: int | None, attend: Callable[[], None]) -> None:
        """Drop the ball anew; a ``seed`` begins the sequence of ball starts anew.

        Raises:
            PlantInterrupted: the simulator refuses; the message has its reason.
        """
        if seed is not None:
            parameter = Parameter('seed', value=seed).to_parameter_msg()
            answer = self._call(self._seed, SetParameters.Request(parameters=[parameter]), attend)
            for result in answer.results:
                self._insist(self._seed, result.successful, result.reason)
        answer = self._call(self._reset, Trigger.Request(), attend)
        self._insist(self._reset, answer.success, answer.message)

    @staticmethod
    def _insist(client: Any, success: bool, message: str) -> None:
        if not success:
            raise PlantInterrupted(f'{client.service_name} was refused: {message or "no reason is given"}')

    def is_there(self) -> bool:
        """Whether its services are up."""
        return all(client.service_is_ready() for client in (self._rest, self._reset, self._seed))

    def _call(self, client: Any, request: Any, attend: Callable[[], None]) -> Any:
        """The answer; asked for again when it does not come."""
        future = None
        ask_again = time.monotonic() + ANSWER_SECONDS
        while True:
            if future is None and client.service_is_ready():
                future = client.call_async(request)
                ask_again = time.monotonic() + ANSWER_SECONDS
            self._background.spin_once(0.05)
            if future is not None and future.done():
                return future.result()
            if time.monotonic() > ask_again:
                self._node.get_logger().warning(
                    f'no answer on {client.service_name} for {ANSWER_SECONDS:.0f} s: is the simulator running?',
                    throttle_duration_sec=5.0)
                if future is not None:
                    client.remove_pending_request(future)
                future = None
                ask_again = time.monotonic() + ANSWER_SECONDS
            attend()
