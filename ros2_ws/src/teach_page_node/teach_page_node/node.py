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

"""A page to teach from: the arm, the tray and the ball in 3D, the keys, the lesson.

Publishes /human/keys and shows what it hears. Open the address that it prints, or that the session prints which
started it; one page teaches, others watch.
"""

import asyncio
import os
from pathlib import Path

from rclpy.node import Node
from shared_control.teaching.feedback import FEEDBACK
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.parameters import declare
from shared_control_ros.runner import Stop, run
from shared_control_ros.task_parameter import declare_task

from .address import TOKEN_VARIABLE
from .live import LiveDesk
from .server import PageServer
from .showing import Showing


class TeachPageNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('teach_page_node')
        host = declare(
            node, 'host', '127.0.0.1', "Address to listen on. Another than loopback's opens the page to the network, "
            'and then it needs a token.')
        port = declare(node, 'port', 8088, 'Port to listen on; 0: any that is free.', minimum=0, maximum=65535)
        token = declare(node, 'token', '', 'What the address must end with when the page is open to the network; '
                        'empty: taken from the environment, or one that stays for whoever starts the node again.')
        frame_rate = declare(
            node, 'frame_rate', 40.0, 'Pictures that are sent.', unit='Hz', minimum=1.0, maximum=100.0)
        session = declare(node, 'session', '', 'Folder of the session, of whose end and result the page tells; empty: '
                          'there is none.')
        showing = Showing(
            declare(node, 'feedback', 'full', 'What the page tells besides tray, ball and keys. ball: how each episode '
                    "ended. full: and the robot's push, human share, score and tests.", choices=FEEDBACK),
            declare(node, 'verdicts', True, 'Offer to call the last episode good, bad or discarded.'),
            bool(session),
            declare(node, 'shows_result', True, 'Show test, picture and report in the end.'))
        task = declare_task(node, 'What is taught: the tray, and the keys.')
        self._desk = LiveDesk(node, task, showing, Path(session) if session else None)
        given = os.environ.get(TOKEN_VARIABLE, '')
        self._tells_address = not given  # otherwise whoever gave it tells: a session keeps what this node says
        self._diagnostics = Diagnostics(node, 1.0 / frame_rate)
        self._server = PageServer(self._desk, host, port, frame_rate, given or token)

    def run(self, stop: Stop) -> None:
        """Serve the page until told to stop."""
        if self._tells_address:
            self.node.get_logger().info(f'open {self._server.address}')
        asyncio.run(self._server.serve(lambda: self._attend(stop)))

    def _attend(self, stop: Stop) -> bool:
        """Called before each picture: whether the page is to be closed."""
        self._diagnostics.tick()
        if self._diagnostics.due():
            self._diagnostics.publish({})
        return stop.requested

    def close(self) -> None:
        """Leave no moment behind."""
        self._desk.close()


def main() -> int:
    """Entry point."""
    return run(TeachPageNode)


if __name__ == '__main__':
    raise SystemExit(main())
