"""``make bench`` and ``make test`` go on where a part of them cannot."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def bench(tmp_path):
    """``bench(**modules)``: measure with these modules instead; exit code, output, figures."""
    def run(**modules):
        for name, text in modules.items():
            (tmp_path / f'{name}.py').write_text(text)
        names = {name: name for name in modules}
        code = f'import bench; bench.MEASUREMENTS = {names}; raise SystemExit(bench.main())'
        output = tmp_path / 'out' / 'bench.json'
        done = subprocess.run(
            [sys.executable, '-c', code, '--output', output], capture_output=True, text=True, check=False,
            env={**os.environ, 'PYTHONPATH': f'{tmp_path}:{ROOT / "benchmarks"}'})
        return done.returncode, done.stdout + done.stderr, json.loads(output.read_text())

    return run


WORKS = 'def measure(): return {"ticks": 7}'


def test_what_is_missing_is_named_and_the_rest_is_measured(bench):
    code, said, figures = bench(
        browser='def measure(): return {"factor": 1.0, "missing": "no Chromium: install it"}',
        package='import no_such_package', works=WORKS)
    assert code == 0
    assert figures['works'] == {'ticks': 7} and figures['browser']['factor'] == 1.0
    named = [line for line in said.splitlines() if 'not all was measured' in line]
    assert [line.partition(':')[0] for line in named] == ['browser', 'package']
    assert 'no Chromium: install it' in named[0] and 'no_such_package' in named[1] and 'Traceback' not in said


def test_a_measurement_that_fails_takes_no_other_with_it(bench):
    code, said, figures = bench(works=WORKS, breaks='def measure(): raise RuntimeError("broken")', too=WORKS)
    assert code == 1 and 'RuntimeError: broken' in said and 'failed: breaks' in said
    assert figures['works'] == figures['too'] == {'ticks': 7}


@pytest.mark.parametrize('failing', ['not alone', 'alone', None])
def test_the_tests_that_run_alone_run_whatever_the_others_did(tmp_path, failing):
    fake = tmp_path / 'bin' / 'python'
    fake.parent.mkdir()
    fake.write_text(f'#!/bin/sh\necho "$*" >> {tmp_path}/calls\ncase "$*" in *"-m {failing}"*) exit 1;; esac\n')
    fake.chmod(0o755)
    (tmp_path / 'ready').touch()
    make = ['make', '--silent', f'VENV={tmp_path}', '--old-file', f'{tmp_path}/ready', 'test']
    done = subprocess.run(make, cwd=ROOT, check=False, capture_output=True)
    calls = (tmp_path / 'calls').read_text().splitlines()
    assert [call.split(' --')[0] for call in calls] == ['-m pytest -m not alone', '-m pytest -m alone']
    assert (done.returncode != 0) == (failing is not None)
