"""What the page asks of the other nodes, besides what the terminal does."""

from collections.abc import Callable

from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.watching.requests import Requests
from std_srvs.srv import Trigger

_HINT = 'is the learner (ppo_agent_node) running?'


class PageRequests(Requests):
    """Also: begin to teach, and start the episode over."""

    def __init__(self, node: Node, tell: Callable[[str], None]):
        super().__init__(node, tell)
        self._start = node.create_client(Trigger, contract.START_SERVICE)
        self._repeat = node.create_client(Trigger, contract.REPEAT_SERVICE)

    def start(self) -> None:
        """Practice is over: teach."""
        self._call(self._start, Trigger.Request(), self._answered, _HINT)

    def repeat(self) -> None:
        """The episode is void: start it over."""
        self._call(self._repeat, Trigger.Request(), self._answered, _HINT)

    def _answered(self, response: Trigger.Response) -> None:
        self._tell(response.message)
