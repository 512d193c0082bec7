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

"""How fast a session ran, from what the simulator reports of itself."""

import math
from dataclasses import astuple, dataclass
from itertools import pairwise

from .reader import Bag
from .recorded import Status

OF_A_SIMULATOR = ('ticks', 'running_seconds')
"""Values by which the reports of a simulator are found on /diagnostics, whatever its node is called."""


@dataclass(frozen=True)
class Timing:
    """Figures of all runs of the simulator in a bag (one, unless it was restarted)."""

    control_rate_hz: float
    """Ticks a second, pauses excluded."""
    real_time_factor: float
    """Simulated over running seconds, pauses excluded."""
    tick_p50_ms: float
    """Median duration of a tick, of the longest run."""
    tick_p99_ms: float
    """99th percentile, likewise."""
    late_tick_ratio: float
    """Part of the ticks that took more than a millisecond."""


def simulator_runs(bag: Bag) -> list[Status]:
    """The last report of each run of the simulator: a run begins where its tick counter begins anew."""
    statuses = sorted(
        (status for reports in bag.statuses.values() for status in reports
         if all(status.number(key) is not None for key in OF_A_SIMULATOR)), key=lambda status: status.received_ns)
    ends = [status for status, after in pairwise(statuses)
            if (after.number('ticks') or 0.0) < (status.number('ticks') or 0.0)]
    return ends + statuses[-1:]


def timing_of(bag: Bag) -> Timing | None:
    """None when the simulator never reported, or does not report these figures (a real robot)."""
    runs = simulator_runs(bag)
    if not runs:
        return None
    totals = {key: sum(_known(run.number(key)) for run in runs)
              for key in (*OF_A_SIMULATOR, 'late_ticks', 'simulated_seconds')}
    longest = max(runs, key=lambda run: _known(run.number('ticks')))
    timing = Timing(
        control_rate_hz=_ratio(totals['ticks'], totals['running_seconds']),
        real_time_factor=_ratio(totals['simulated_seconds'], totals['running_seconds']),
        tick_p50_ms=_known(longest.number('tick_p50_ms')), tick_p99_ms=_known(longest.number('tick_p99_ms')),
        late_tick_ratio=_ratio(totals['late_ticks'], totals['ticks']))
    return timing if all(map(math.isfinite, astuple(timing))) else None


def _known(value: float | None) -> float:
    return math.nan if value is None else value


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else math.nan
