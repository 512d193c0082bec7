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

"""What a person asks of the other nodes: begin to teach, end it, pause, go on."""

import time
from collections.abc import Callable

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import SetBool, Trigger

from .. import contract
from .pause import Pause

ANSWER_WITHIN = 3.0
"""s"""
RUNS_AGAIN_NS = 500_000_000
"""So far beyond its pause, simulation time has been let go on by somebody else; less may still have been under way.
Where the simulator reports its pauses, that is not asked."""
HINT = 'is the learner (ppo_agent_node) running?'


class Requests:
    """Calls services without waiting for them.

    Args:
        tell: takes a line for the person.
        pause: what is known of it; kept up to date by somebody else.
    """

    def __init__(self, node: Node, tell: Callable[[str], None], pause: Pause):
        self._tell = tell
        self._pause = pause
        self._finish = node.create_client(Trigger, contract.FINISH_SERVICE)
        self._keep_teaching = node.create_client(Trigger, contract.KEEP_TEACHING_SERVICE)
        self._start = node.create_client(Trigger, contract.START_SERVICE)
        self._pausing = node.create_client(SetBool, contract.PAUSE_SERVICE)
        self._pending: dict[Future, tuple[Client, float]] = {}
        self._paused_ns = 0
        self.ending = False
        """Whether the teaching ends with this episode, because it was asked for here."""

    @property
    def paused(self) -> bool:
        """Whether the simulation is paused, by whomever."""
        return self._pause.is_on

    @property
    def is_pending(self) -> bool:
        """Whether an answer is due: let the node's executor look for it."""
        return bool(self._pending)

    def finish(self) -> None:
        """Enough is taught: end the lesson with this episode."""
        def answered(response: Trigger.Response) -> None:
            self._tell(response.message or ('The lesson ends.' if response.success else 'The learner refused to end.'))
            self.ending = response.success
        self._call(self._finish, Trigger.Request(), answered, HINT)

    def keep_teaching(self) -> None:
        """Take :meth:`finish` back."""
        def answered(response: Trigger.Response) -> None:
            self._tell(response.message)
            self.ending = False  # a learner that refuses this was not to end
        self._call(self._keep_teaching, Trigger.Request(), answered, HINT)

    def start(self) -> None:
        """Practice is over: teach."""
        self._call(self._start, Trigger.Request(), lambda response: self._tell(response.message), HINT)

    def toggle_pause(self, stamp_ns: int) -> None:
        """Pause the simulator, or go on; ``stamp_ns``: the newest simulation time."""
        self.pause(not self.paused, stamp_ns)

    def pause(self, pause: bool, stamp_ns: int) -> None:
        """Pause the simulator whether or not it is paused, or go on likewise.

        A pause is known from the report, which may come before the answer: a new wish does not wait for that.
        """
        self._paused_ns = stamp_ns
        self._give_up([future for future, (client, _) in self._pending.items() if client is self._pausing])

        def answered(response: SetBool.Response) -> None:
            if response.success:
                self._pause.is_on = pause
            self._tell('' if response.success else f'Could not {"pause" if pause else "go on"}: {response.message}')
        self._call(self._pausing, SetBool.Request(data=pause), answered, 'this robot cannot be paused.')

    def follow(self, phase: str | None, stamp_ns: int) -> None:
        """Bring up to date what still holds.

        Args:
            phase: of the lesson; None when it is not known.
            stamp_ns: the newest simulation time.
        """
        if not self._pause.is_reported and stamp_ns > self._paused_ns + RUNS_AGAIN_NS:
            self._pause.is_on = False
        if phase not in (None, 'teach', 'learn', 'wait'):  # a last episode that is void begins anew
            self.ending = False

    def expire(self) -> None:
        """Give up what was not answered in time."""
        now = time.monotonic()
        for client in self._give_up([future for future, (_, deadline) in self._pending.items() if now > deadline]):
            self._tell(f'No answer from {client.service_name} within {ANSWER_WITHIN:.0f} s.')

    def _give_up(self, futures: list[Future]) -> list[Client]:
        """Take no answer any more; whose they would have been."""
        clients = []
        for future in futures:
            client, _ = self._pending.pop(future)
            client.remove_pending_request(future)
            clients.append(client)
        return clients

    def _call(self, client: Client, request: object, answered: Callable, hint: str) -> None:
        if any(pending is client for pending, _ in self._pending.values()):
            return
        if not client.service_is_ready():
            self._tell(f'Nobody serves {client.service_name}: {hint}')
            return

        def done(future: Future) -> None:
            if self._pending.pop(future, None) is not None:
                answered(future.result())
        future = client.call_async(request)
        self._pending[future] = client, time.monotonic() + ANSWER_WITHIN
        future.add_done_callback(done)
