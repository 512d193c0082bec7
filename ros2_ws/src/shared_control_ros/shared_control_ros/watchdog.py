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

"""Ends a node whose loop stands still: who started it says so and starts it again."""

import signal

STANDSTILL = 10.0
"""A loop that has not come round for this long does so no more, s."""


class Watchdog:
    """To be fed by a node's loop, once a second or so, from the first round on.

    The system's timer ends the process by SIGALRM, whatever its threads are at: a thread of real-time priority that
    spins on a lock has kept the loop that held it, and everything else on that core, from running for minutes. So no
    thread of this process is to do it, and the loop waits for none.
    """

    def __init__(self, standstill: float = STANDSTILL):
        self._standstill = standstill

    def feed(self) -> None:
        """The loop has come round."""
        signal.setitimer(signal.ITIMER_REAL, self._standstill)


def leave_within(seconds: float) -> None:
    """No loop is watched any more: the process ends by SIGALRM after ``seconds``, whatever holds it up."""
    signal.setitimer(signal.ITIMER_REAL, seconds)
