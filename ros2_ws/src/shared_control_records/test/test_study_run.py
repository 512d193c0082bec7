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

"""Doing the runs of a study: killed half-way, on a full disk, on a Ray cluster."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from shared_control.cli import main
from shared_control_learning.episode_table import read_rows
from shared_control_records.study import result as result_module
from shared_control_records.study.folder import StudyFolder
from shared_control_records.study.plan import load_plan
from shared_control_records.study.pool import on_ray, on_this_machine
from shared_control_records.study.result import RESULT, TESTS, ResultError, is_done, load_result
from shared_control_testing.studies import made_study

PLAN = """
participants: {simulated: {expert: 1, high: 1}}
conditions: {autonomous: {episodes: 2, taught: false, evaluate_every: 2}}
tests: []
"""
SECONDS = 600.0
"""More than enough for what is waited for here."""


@pytest.fixture
def plan(tmp_path):
    path = tmp_path / 'plan.yaml'
    path.write_text(PLAN)
    return path


def wait_until(condition):
    deadline = time.monotonic() + SECONDS
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def processes(session):
    """Those of a session that live."""
    found = []
    for path in Path('/proc').glob('[0-9]*'):
        with suppress(OSError):  # it has just ended
            if os.getsid(int(path.name)) == session and (path / 'cmdline').read_bytes():
                found.append(int(path.name))
    return found


def fill(path):
    """Leave no room on a disk."""
    with suppress(OSError), path.open('wb', buffering=0) as file:
        while True:
            file.write(bytes(4096))


def test_a_study_that_is_killed_goes_on_with_nothing_lost_and_nothing_twice(plan, tmp_path):
    folder = StudyFolder(tmp_path / 'study')
    first, second = (folder.run(job) for job in load_plan(plan).jobs)
    command = [sys.executable, '-m', 'shared_control', 'study', str(plan), '--output', str(folder.path),
               '--workers', '1']
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True) as study:
        try:
            # The policy is written after the row: without it the episode is done again.
            wait_until(lambda: is_done(first) and len(read_rows(second / 'episodes.csv')) == 1
                       and (second / 'policy.safetensors').exists())
        finally:
            study.kill()
    wait_until(lambda: not processes(study.pid))
    assert not is_done(second)
    kept = {path: path.stat().st_mtime_ns for path in first.iterdir()}
    run = json.loads((second / 'run.json').read_text())
    (second / 'run.json').write_text(json.dumps(run | {'seconds': 1000.0}))
    again = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    assert again.returncode == 0, again.stderr
    assert 'autonomous/p01' not in again.stdout and 'autonomous/p02: not skilled' in again.stdout
    assert {path: path.stat().st_mtime_ns for path in first.iterdir()} == kept
    result = load_result(second)
    assert [row['episode'] for row in result.episodes] == [1, 2]
    assert result.seconds > 1000.0, 'the part before it was killed counts'


def test_a_study_that_is_asked_to_leave_says_how_to_go_on(plan, tmp_path):
    run = StudyFolder(tmp_path / 'study').run(load_plan(plan).jobs[0])
    command = [sys.executable, '-m', 'shared_control', 'study', str(plan), '--output', str(tmp_path / 'study')]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          start_new_session=True) as study:
        try:
            wait_until(run.exists)
            study.terminate()  # as a cluster's scheduler does
            said = study.communicate(timeout=SECONDS)[1]
        finally:
            study.kill()
    assert study.returncode == 130 and 'the same command goes on' in said and 'Traceback' not in said
    wait_until(lambda: not processes(study.pid))


@pytest.mark.parametrize('content', ['', '{}', '{"seconds": "long", "skilled": null}', '[]'])
def test_a_damaged_result_is_named(plan, tmp_path, monkeypatch, capsys, content):
    result = StudyFolder(tmp_path / 'study').run(load_plan(plan).jobs[0]) / 'result.json'
    result.parent.mkdir(parents=True)
    result.write_text(content)
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(tmp_path / 'study')])
    assert main() == 2
    assert f'remove {result} and run the study again' in capsys.readouterr().err


def test_runs_that_cannot_be_read_are_named_beside_the_table_of_the_others(plan, tmp_path, monkeypatch, capfd):
    plan.write_text(PLAN.replace('episodes: 2', 'episodes: 9'))
    folder = made_study(tmp_path / 'study', plan)
    del folder._lock
    first, second = (folder.run(job) for job in load_plan(plan).jobs)
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(folder.path), '--json', '-'])
    assert main() == 0
    said = json.loads(capfd.readouterr().out)
    assert (said['cells'][0]['runs'], said['left_out']) == (2, [])

    whole = (first / TESTS).read_bytes()
    for damage in (lambda: (first / TESTS).write_bytes(whole[:len(whole) // 2]), (first / TESTS).unlink):
        damage()
        assert main() == 2
        out, error = capfd.readouterr()
        said = json.loads(out)
        assert said['cells'][0]['runs'] == 1
        assert '1 of 2 runs cannot be read' in error and f'remove {first / RESULT} and run the study again' in error
        [left_out] = said['left_out']
        assert 'runs/autonomous/p01 is damaged' in left_out and str(tmp_path) not in left_out
        assert str(second) not in error


@pytest.mark.parametrize(('array', 'said'), [
    ('alone/seconds', 'bytes unpacked, expected 100000 at the most'),
    ('alone/secrets', "has 'alone/secrets.npy', expected of each test seconds, position_error"),
    ('secrets', "has 'secrets.npy', expected of each test seconds")])
def test_tests_that_would_take_all_memory_or_are_none_are_refused_unread(plan, tmp_path, monkeypatch, array, said):
    plan.write_text(PLAN.replace('tests: []', 'tests: [perturbation]'))
    folder = made_study(tmp_path / 'study', plan)
    run = folder.run(load_plan(plan).jobs[0])
    whole = dict(np.load(run / TESTS))
    np.savez_compressed(run / TESTS, **whole, **{array: np.zeros(1_000_000)})
    monkeypatch.setattr(result_module, 'TESTS_MOST', 100_000)
    monkeypatch.setattr(np, 'load', None)
    with pytest.raises(ResultError, match=rf'tests\.npz.* {said}'):
        load_result(run)
    monkeypatch.undo()
    np.savez_compressed(run / TESTS, **whole)
    assert load_result(run).tests


def test_a_study_of_people_names_them_too(plan, tmp_path, monkeypatch, capfd):
    plan.write_text('participants: {real: 1, consent: "Yes?"}\nconditions: {autonomous: {episodes: 9, taught: false}}')
    folder = made_study(tmp_path / 'study', plan)
    del folder._lock
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(folder.path)])
    assert main() == 0
    (folder.run(load_plan(plan).jobs[0]) / TESTS).unlink()
    assert main() == 2 and '1 of 1 runs cannot be read' in capfd.readouterr().err


def test_what_is_finished_before_the_disk_is_full_stays_usable(plan, tmp_path, monkeypatch, capfd):
    disk = tmp_path / 'disk'
    disk.mkdir()
    mounted = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=4m', 'tmpfs', disk], capture_output=True, check=False)
    if mounted.returncode:
        pytest.skip(f'a small disk cannot be mounted here: {mounted.stderr.decode().strip()}')
    try:
        folder = made_study(disk / 'study', plan, missing=1)
        del folder._lock
        fill(disk / 'filler')
        monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(folder.path)])
        assert main() == 2
        said = capfd.readouterr().err
        assert '1 of 2 runs failed' in said and 'autonomous/p02: [Errno 28] No space left on device' in said
        assert 'start the same command again' in said
        assert load_result(folder.run(load_plan(plan).jobs[0])) is not None

        (disk / 'filler').unlink()
        assert main() == 0
        assert is_done(folder.run(load_plan(plan).jobs[1]))
    finally:
        subprocess.run(['umount', '--lazy', disk], check=True)


def test_a_run_that_fails_is_named_with_its_reason(plan, tmp_path, monkeypatch, capfd):
    folder = made_study(tmp_path / 'study', plan, missing=1)
    del folder._lock
    run = folder.run(load_plan(plan).jobs[1])
    run.mkdir(parents=True)
    (run / 'policy.safetensors').write_bytes(b'half a policy')
    (run / 'run.json').write_text('{')
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(folder.path)])
    assert main() == 2
    said = capfd.readouterr().err
    assert f'autonomous/p02: {run}' in said and 'What is finished is kept' in said


def test_a_run_that_is_killed_is_named_and_the_others_are_done(plan, tmp_path):
    folder = StudyFolder(tmp_path / 'study')
    folder.begin(plan)
    first, second = load_plan(plan).jobs
    outcomes = {}
    for ended in on_this_machine(folder.path, [first.name, second.name], 1):
        outcomes |= dict(ended)
        if not outcomes and (folder.run(first) / 'run.json').exists():
            multiprocessing.active_children()[0].kill()
    assert 'was killed' in outcomes[first.name] and outcomes[second.name] is None
    assert is_done(folder.run(second)) and not is_done(folder.run(first))


def test_control_c_ends_all_processes(plan, tmp_path):
    folder = StudyFolder(tmp_path / 'study')
    command = [sys.executable, '-m', 'shared_control', 'study', str(plan), '--output', str(folder.path),
               '--workers', '2']
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          start_new_session=True) as study:
        wait_until(lambda: all((folder.run(job) / 'run.json').exists() for job in load_plan(plan).jobs))
        os.killpg(study.pid, signal.SIGINT)  # as a terminal does
        said, _ = study.communicate(timeout=SECONDS)
    assert study.returncode == 130
    assert not processes(study.pid)
    assert 'Traceback' not in said


def test_a_local_ray_cluster_does_the_same_list(plan, tmp_path):
    pytest.importorskip('ray', reason='optional: pip install ray')
    folder = StudyFolder(tmp_path / 'study')
    folder.begin(plan)
    names = [job.name for job in load_plan(plan).jobs]
    ended = [outcome for outcomes in on_ray(folder.path, [*names, 'autonomous/p09'], 'local') for outcome in outcomes]
    assert {outcome.name: outcome.error is None for outcome in ended} == {
        **dict.fromkeys(names, True), 'autonomous/p09': False}
    assert all(is_done(folder.run(job)) for job in load_plan(plan).jobs)


def test_without_a_cluster_that_is_said(plan, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(plan), '--output', str(tmp_path / 'study'),
                                     '--ray', 'nowhere'])
    assert main() == 2
    assert 'Ray' in capsys.readouterr().err
