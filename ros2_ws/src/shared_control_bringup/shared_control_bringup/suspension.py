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

"""Ctrl-Z in the terminal of a session."""

import os
import signal
import time
from types import FrameType

from .node_process import NodeProcess

LEAVES_WITHIN = 3.0
"""The node at the terminal pauses the simulation and leaves the screen within this, s."""


class Suspension:
    """While it is entered, this process stops at Ctrl-Z only after the node that draws in the terminal has stopped.

    The shell takes the terminal back as soon as this process stops: what the node still does to it would be done to the
    shell's prompt.

    Args:
        node: None: nobody draws, and this process stops at once.
    """

    def __init__(self, node: NodeProcess | None):
        self._node = node
        self._requested = False

    def poll(self) -> None:
        """Stop here if somebody has pressed Ctrl-Z; comes back when the shell lets this process go on."""
        if not self._requested or self._node is None:
            return
        deadline = time.monotonic() + LEAVES_WITHIN
        while self._node.exit_code() is None and not self._node.held_by() and time.monotonic() < deadline:
            time.sleep(0.02)
        self._requested = False
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, self._note)

    def __enter__(self) -> 'Suspension':
        if self._node is not None:
            self._previous = signal.signal(signal.SIGTSTP, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        if self._node is not None:
            signal.signal(signal.SIGTSTP, self._previous)

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self._requested = True
