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

"""How long the ticks of a whole run took."""

import numpy as np

_BIN = 2e-6
_BINS = 50_000


class TickTimes:
    """A histogram of tick durations with bins of 2 us up to 100 ms: quantiles of a run of any length."""

    def __init__(self) -> None:
        self._counts = np.zeros(_BINS, np.int64)
        self.late = 0
        """Ticks that took more than a millisecond."""
        self.total = 0

    def add(self, seconds: float) -> None:
        """One more tick."""
        self._counts[min(int(seconds / _BIN), _BINS - 1)] += 1
        self.total += 1
        self.late += seconds > 1e-3

    def quantile_ms(self, fraction: float) -> float:
        """Duration that ``fraction`` of the ticks stay below, ms; nan without ticks."""
        if not self.total:
            return float('nan')
        index = int(np.searchsorted(np.cumsum(self._counts), fraction * self.total))
        return (index + 1) * _BIN * 1e3
