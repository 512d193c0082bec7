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

"""What the page asks of the other nodes, besides what the terminal does."""

from collections.abc import Callable

from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.watching.pause import Pause
from shared_control_ros.watching.requests import HINT, Requests
from std_srvs.srv import Trigger


class PageRequests(Requests):
    """Also: start the episode over."""

    def __init__(self, node: Node, tell: Callable[[str], None], pause: Pause):
        super().__init__(node, tell, pause)
        self._repeat = node.create_client(Trigger, contract.REPEAT_SERVICE)

    def repeat(self) -> None:
        """The episode is void: start it over."""
        self._call(self._repeat, Trigger.Request(), lambda response: self._tell(response.message), HINT)
