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
