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

"""Runs the faults of a plan against sessions on the live graph, and looks at what has become of each."""

import multiprocessing
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from .checks import violations
from .machine import Machine
from .plan import Fault
from .session import Outcome, Seen, run_session

SILENT_S = 400.0
"""Longer than a session goes on without a fault, or takes to end."""
LEAVE_S = 15.0
"""Time for the process of a session to end."""
_PROCESSES = multiprocessing.get_context('spawn')  # what a middleware holds locked at a fork stays so


class Campaign:
    """A row of sessions and the faults that befall them.

    Args:
        faults: in their order.
        folder: for the sessions' folders; made.
        domain: the ROS domain of the sessions.
        say: called with a line for every fault.
    """

    def __init__(self, faults: list[Fault], folder: Path, domain: int, say: Callable[[str], None] = print):
        folder.mkdir(parents=True, exist_ok=True)
        Machine(folder).close()  # what is missing for it is found out before anything starts
        self._waiting = list(faults)
        self._folder, self._domain, self._say = folder, domain, say
        self.outcomes: list[Outcome] = []

    def run(self, deadline: float = float('inf')) -> list[Outcome]:
        """All faults, or those that begin before ``deadline`` (``time.monotonic()``).

        An interrupt ends the session that runs; :attr:`outcomes` has those of the sessions before it.
        """
        number = 0
        while self._waiting and time.monotonic() < deadline:
            number += 1
            self._see_session(self._folder / f'session_{number:03d}', deadline)
        return self.outcomes

    def _see_session(self, folder: Path, deadline: float) -> None:
        """Run a session from a process of its own, and look at what has become of it.

        A garbled packet can hold up the middleware of whoever receives it for ever (seen: Fast DDS 2.14, in a gap of
        messages without end). A node of the session that stands still so is ended by its supervisor, the campaign's
        own node here.
        """
        results, sender = _PROCESSES.Pipe(duplex=False)
        process = _PROCESSES.Process(target=run_session, args=(self._waiting, folder, self._domain, deadline, sender))
        process.start()
        sender.close()
        seen = Seen()
        try:
            with suppress(EOFError):
                while not seen.ended and results.poll(SILENT_S):
                    told = results.recv()
                    if isinstance(told, Seen):
                        seen = told
                    else:
                        self._say(told)
        finally:
            process.join(LEAVE_S)
            process.kill()
            process.join()
        if seen.ended:
            clock_was_set = any(outcome.fault.kind == 'clock' for outcome in seen.outcomes)
            self._check(folder, seen.outcomes, [] if clock_was_set else seen.killed_ns)
        else:  # the faults before the last one are done again
            how = 'stood still' if process.exitcode == -signal.SIGKILL else f'failed ({process.exitcode})'
            seen.outcomes = seen.outcomes[-1:]
            for outcome in seen.outcomes:
                outcome.judged = False
                self._say(f'{outcome.fault} ({folder.name}): not judged, since the process that saw it {how}')
        done = [outcome.fault for outcome in seen.outcomes]
        self._waiting = [fault for fault in self._waiting if fault not in done]
        self.outcomes += seen.outcomes

    def _check(self, folder: Path, outcomes: list[Outcome], killed_ns: list[int]) -> None:
        """What does not hold in the folder counts for the session's last fault; the line says which session."""
        if not outcomes:
            return
        lost_rows = any(outcome.fault.target == 'session_recorder_node' for outcome in outcomes)
        outcomes[-1].violations += violations(folder, killed_ns, lost_rows)
        for outcome in outcomes:
            for violation in outcome.violations:
                self._say(f'VIOLATION after {outcome.fault} ({outcome.session}): {violation}')
