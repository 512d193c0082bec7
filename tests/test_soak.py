"""The soak: what it calls growth, and a short one for real."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SCRIPT = Path(__file__).parents[1] / 'benchmarks' / 'soak.py'


@pytest.fixture(scope='module')
def soak(load_benchmark):
    return load_benchmark('soak')


@pytest.mark.parametrize(('slope', 'step', 'grows'), [(0.5, 0.0, True), (0.1, 0.0, False), (0.0, 20.0, False)])
def test_a_slope_is_a_failure_and_what_warming_up_takes_is_not(soak, slope, step, grows):
    noise = np.random.default_rng(0).normal(0.0, 0.3, 60)
    samples = [soak.Sample(minute, 'node', memory_mb=100.0 + slope * minute + step * (minute >= 5) + noise[minute])
               for minute in range(60)]
    assert bool(soak.growth(samples)) is grows


def test_a_short_one(tmp_path, domain_id):
    output = tmp_path / 'soak.json'
    subprocess.run([sys.executable, SCRIPT, '--minutes', '0.1', '--every', '0.05', '--output', output], check=True,
                   timeout=300, capture_output=True)
    samples = json.loads(output.read_text())['samples']
    assert {sample['of'] for sample in samples} >= {'panda_sim_node', 'torque_ctrl_node', 'ppo_agent_node', 'session'}
    ticks = [sample['tick_p50_ms'] for sample in samples if sample['of'] == 'all']
    assert len(ticks) == 2 and max(ticks) > 0.0
    assert all(sample['cpu_percent'] > 0.0 for sample in samples if sample['of'] == 'panda_sim_node')
    assert all(sample['memory_mb'] > 10.0 and sample['threads'] >= 1 for sample in samples if sample['of'] != 'all')
