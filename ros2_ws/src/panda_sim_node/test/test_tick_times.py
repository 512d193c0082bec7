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

"""Statistics of a run's ticks."""

import math

import pytest
from panda_sim_node.tick_times import TickTimes


def test_quantiles_and_late_ticks():
    times = TickTimes()
    assert math.isnan(times.quantile_ms(0.5))
    for microseconds in range(10, 2010, 10):
        times.add(microseconds * 1e-6 - 1e-9)
    assert times.quantile_ms(0.5) == pytest.approx(1.0, abs=0.02)
    assert times.quantile_ms(0.99) == pytest.approx(1.98, abs=0.03)
    assert (times.total, times.late) == (200, 100)


def test_a_very_long_tick_counts_too():
    times = TickTimes()
    times.add(30.0)
    assert times.late == 1 and times.quantile_ms(0.99) >= 99.0
