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

"""When the system's clock was set: by a person, by NTP after a start with a wrong time, or by a machine that slept."""

import time

SMALLEST = 0.2
"""A smaller step is none, s: clocks are kept right by steps of less."""
_AT_ONCE = 0.001
_TRIES = 20


class ClockSteps:
    """Compares the clock of the day with one that nobody sets, from call to call."""

    def __init__(self) -> None:
        self._ahead = _ahead()

    def new(self) -> float:
        """By how much the clock was set forward since the last call, s; negative: back; 0: it was not."""
        before, self._ahead = self._ahead, _ahead()
        step = self._ahead - before
        return step if abs(step) >= SMALLEST else 0.0


def in_words(step: float) -> str:
    """What has happened, for a log."""
    return (f"this machine's clock was set {'forward' if step > 0.0 else 'back'} by {abs(step):.1f} s"
            f"{', or it slept' if step > 0.0 else ''}")


def _ahead() -> float:
    """The time of the day minus the time since the start of the machine, s, both of one moment."""
    ahead = 0.0
    for _ in range(_TRIES):
        before = time.monotonic()
        ahead, after = time.time() - before, time.monotonic()
        if after - before < _AT_ONCE:  # nobody else came to run in between
            break
    return ahead
