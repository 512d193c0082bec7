"""What the page asks of the other nodes, besides what the terminal does."""

from collections.abc import Callable

from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.watching.requests import HINT, Requests
from std_srvs.srv import Trigger


class PageRequests(Requests):
    """Also: start the episode over."""

    def __init__(self, node: Node, tell: Callable[[str], None]):
        super().__init__(node, tell)
        self._repeat = node.create_client(Trigger, contract.REPEAT_SERVICE)

    def repeat(self) -> None:
        """The episode is void: start it over."""
        self._call(self._repeat, Trigger.Request(), lambda response: self._tell(response.message), HINT)
