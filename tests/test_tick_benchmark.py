"""The breakdown of a tick of the live loop: it is whole, and it adds up."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / 'benchmarks' / 'tick.py'


@pytest.fixture(scope='module')
def figures():
    said = subprocess.run([sys.executable, SCRIPT], check=True, stdout=subprocess.PIPE, text=True, timeout=600).stdout
    return json.loads(said)


def test_the_parts_add_up_to_the_tick(figures):
    parts = [part['mean'] for part in figures['parts_us'].values()]
    assert figures['ticks'] > 100 and all(part >= 0.0 for part in parts)
    assert sum(parts) == pytest.approx(figures['tick_us']['mean'], abs=1.0)
    assert sum(part['share'] for part in figures['parts_us'].values()) == pytest.approx(1.0, abs=0.01)
    assert figures['period_us']['mean'] > figures['tick_us']['mean']


def test_the_same_work_is_timed_in_process(figures):
    assert len(figures['in_process_us']) == 3 and all(time > 0.0 for time in figures['in_process_us'].values())
