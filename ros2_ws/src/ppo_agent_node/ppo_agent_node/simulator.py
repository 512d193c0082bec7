"""The services of a simulator, called one after the other."""

from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from std_srvs.srv import SetBool, Trigger

ANSWER_SECONDS = 3.0
"""A simulator that does not answer for this long is asked again: it may have been restarted meanwhile."""


class Simulator:
    """Pauses, resets and seeds the simulator; each call waits until that is done, however long it takes.

    ``attend`` is called again and again meanwhile; it may raise to give up.

    Args:
        node: the node that calls.
        background: serves its answers.
    """

    def __init__(self, node: Node, background: Background):
        self._node = node
        self._background = background
        self._pause = node.create_client(SetBool, contract.PAUSE_SERVICE)
        self._reset = node.create_client(Trigger, contract.RESET_SERVICE)
        self._seed = node.create_client(SetParameters, contract.SEED_SERVICE)

    def pause(self, paused: bool, attend: Callable[[], None]) -> None:
        """Stop time, or let it go on."""
        self._call(self._pause, SetBool.Request(data=paused), attend)

    def reset(self, seed: int | None, attend: Callable[[], None]) -> None:
        """Drop the ball anew; a ``seed`` begins the sequence of ball starts anew."""
        if seed is not None:
            parameter = Parameter('seed', value=seed).to_parameter_msg()
            self._call(self._seed, SetParameters.Request(parameters=[parameter]), attend)
        self._call(self._reset, Trigger.Request(), attend)

    def is_there(self) -> bool:
        """Whether its services are up."""
        return all(client.service_is_ready() for client in (self._pause, self._reset, self._seed))

    def _call(self, client: Any, request: Any, attend: Callable[[], None]) -> None:
        waited = 0.0
        future = None
        while True:
            if future is None and client.service_is_ready():
                future = client.call_async(request)
                waited = 0.0
            self._background.spin_once(0.05)
            if future is not None and future.done():
                return
            waited += 0.05
            if waited > ANSWER_SECONDS:
                self._node.get_logger().warning(
                    f'no answer on {client.srv_name}: is the simulator running?', throttle_duration_sec=5.0)
                future = None
                waited = 0.0
            attend()
