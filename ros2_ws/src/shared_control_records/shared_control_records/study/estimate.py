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

"""How long a study will still take."""

from collections import defaultdict
from collections.abc import Iterable
from statistics import mean

from .plan import Job

GUESS = 4.0
"""Seconds an episode, with its tests, until a run of the condition has told better."""


class TimeLeft:
    """Learns from finished runs how long the others of their condition will take."""

    def __init__(self) -> None:
        self._seconds: dict[str, list[float]] = defaultdict(list)

    def learn(self, job: Job, seconds: float) -> None:
        """A run took that long."""
        self._seconds[job.condition.name].append(seconds)

    def estimate(self, jobs: Iterable[Job], workers: int) -> float:
        """Seconds that ``jobs`` take if ``workers`` share them."""
        return sum(map(self._expected, jobs)) / workers

    def _expected(self, job: Job) -> float:
        known = self._seconds[job.condition.name]
        return mean(known) if known else GUESS * job.condition.episodes


def in_words(seconds: float) -> str:
    """As in ``12 min``."""
    return f'{seconds:.0f} s' if seconds < 90 else f'{seconds / 60:.0f} min' if seconds < 5400 else (
        f'{seconds / 3600:.1f} h')
