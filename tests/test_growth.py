"""How growth is judged, and a short form of the measurement."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / 'benchmarks' / 'growth.py'
SUBJECTS = {'session': {'report', 'read and check'}, 'readers': {'tick of the simulator'}, 'participants': {'report'},
            'sessions': {'parquet', 'lerobot'}}


@pytest.fixture(scope='module')
def growth(load_benchmark):
    return load_benchmark('growth')


def of_power(growth, power, constant):
    """A subject whose CPU and memory grow with a power of the size."""
    return growth.Subject('things', (1, 2, 4, 8), 1, {
        'work': lambda size: {'cpu': constant + size ** power, 'mb': 100.0 * size ** power}})


@pytest.mark.parametrize('power', [0.5, 1, 2])
def test_the_exponent_is_that_of_the_power(growth, power):
    subject = of_power(growth, power, 0.0)
    figures = dict(growth.measured(subject, subject.sizes, 2))['work']
    assert figures['cpu']['exponent'] == figures['mb']['exponent'] == power
    assert (power > growth.LINEAR) is (power == 2)


def test_a_constant_part_hides_less_of_the_larger_sizes(growth):
    """Of the three largest sizes, so that what is done once does not make a square look linear."""
    subject = of_power(growth, 2, 5.0)
    figures = dict(growth.measured(subject, subject.sizes, 1))['work']
    assert figures['cpu']['exponent'] > growth.LINEAR


def test_little_memory_has_no_exponent(growth):
    subject = growth.Subject('things', (1, 2, 4), 1, {'work': lambda size: {'cpu': 1.0, 'mb': 0.1 * size}})
    assert dict(growth.measured(subject, subject.sizes, 1))['work']['mb']['exponent'] is None


@pytest.mark.parametrize('subject', SUBJECTS)
def test_a_short_one(subject, tmp_path):
    done = subprocess.run([sys.executable, SCRIPT, '--quick', '--only', subject, '--output', tmp_path], check=False,
                          timeout=600, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    [(name, steps)] = json.loads((tmp_path / 'growth.json').read_text()).items()
    assert name == subject and set(steps) == SUBJECTS[subject]
    for figures in steps.values():
        assert len(figures['sizes']) == 1 and figures['cpu']['median'][0] > 0.0
    assert all((tmp_path / f'{subject}.{kind}').stat().st_size > 1000 for kind in ('png', 'svg', 'pdf'))
