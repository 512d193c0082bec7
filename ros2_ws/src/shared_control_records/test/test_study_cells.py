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

"""Studies as benchmarks: cells of condition and tutor, policies on the way, the quick form."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from shared_control.cli import main
from shared_control.plugins import LEARNERS, names
from shared_control_learning.evaluation.result import checkpoint
from shared_control_records.study.folder import StudyFolder
from shared_control_records.study.plan import PlanError, load_plan, plan_of, read_plan
from shared_control_records.study.result import RunResult, describe, load_result
from shared_control_records.study_report.cells import as_text, cell_rows
from shared_control_records.study_report.measures import Study
from shared_control_testing.studies import made_result

BASELINES = Path(__file__).parents[4] / 'studies' / 'baselines.yaml'
PLAN = """
participants: {simulated: {reactive: 6, blind: 6}}
conditions: {coached: {episodes: 10}, autonomous: {episodes: 10, taught: false}}
tests: [randomized]
checkpoints: [1, 3]
"""


@pytest.fixture
def plan(tmp_path):
    path = tmp_path / 'plan.yaml'
    path.write_text(PLAN)
    return load_plan(path)


def result(job, skilled, episodes, successes, on_the_way=None):
    """A run: each episode lasts 15 s, of which a tutor holds 3 s in 2 pushes of 4 presses."""
    made = made_result(job, np.random.default_rng(job.participant.number), ('randomized',))
    test = made.tests['randomized']
    tests = {name: type(test)(name, *(getattr(test, field) for field in (
        'seconds', 'position_error', 'velocity', 'velocity_error', 'agent_moment', 'manipulability', 'fallen')),
        success=np.arange(20) < count) for name, count in {'randomized': successes, **(on_the_way or {})}.items()}
    taught = job.condition.taught
    rows = [{'seconds': 15.0, 'intervention_rate': 0.2 * taught, 'presses': 4 * taught, 'interventions': 2 * taught,
             'noise_share': 0.25, 'human_share': 0.1} for _ in range(episodes)]
    return RunResult(**describe(job, True), first_pass=None, skilled=skilled, seconds=1.0, episodes=rows, tests=tests)


def study(plan, make):
    """A study of runs that ``make`` gives, None for those that are not done."""
    return Study(plan, tuple(run for run in map(make, plan.jobs) if run is not None), (), {})


def test_a_cell_tells_what_it_took_until_skilled_and_what_became_of_it(plan):
    def make(job):
        if job.condition.taught:
            return result(job, 2 + job.participant.number % 2, 4, 20, {checkpoint(1): 0, checkpoint(3): 10})
        return result(job, None, 10, 5, {checkpoint(1): 0, checkpoint(3): 5})

    rows = {(row['condition'], row['tutor']): row for row in cell_rows(study(plan, make))}
    assert list(rows) == [('coached', 'reactive'), ('coached', 'blind'), ('autonomous', 'nobody')]
    taught, alone = rows['coached', 'reactive'], rows['autonomous', 'nobody']
    assert (taught['runs'], taught['skilled'], taught['slowest'], taught['episodes_to_skilled']) == (6, 6, 3.0, 2.0)
    assert (taught['robot_seconds_to_skilled'], taught['human_seconds_to_skilled']) == (30.0, 6.0)
    assert (taught['presses_to_skilled'], taught['interventions_an_episode']) == (8.0, 2.0)
    assert taught['noise_share_an_episode'] == 0.25
    assert (taught['success_after_1_episodes'], taught['success_after_3_episodes']) == (0.0, 0.5)
    assert taught['success_in_the_end_against_autonomous'] == pytest.approx(0.75)
    assert taught['sooner_than_autonomous'] == 1.0
    # 3 s are held in an episode: 10 s see the test after 3 episodes, 30 s the last one.
    assert taught['success_after_10_human_seconds'] == 0.5 and taught['success_after_30_human_seconds'] == 1.0
    assert (alone['runs'], alone['skilled'], alone['slowest'], alone['episodes_to_skilled']) == (12, 0, None, None)
    assert alone['success_after_10_human_seconds'] == 0.25, 'nobody has held anything: as it is in the end'
    assert not any(key.startswith('sooner') for key in alone)


def test_a_run_that_never_got_there_counts_and_has_no_median_where_half_of_them_are_so(plan):
    rows = cell_rows(study(plan, lambda job: result(
        job, None if job.participant.number % 3 else 2, 4 if job.participant.number % 3 else 2, 20)))
    assert [(row['skilled'], row['runs'], row['episodes_to_skilled']) for row in rows[:2]] == [(2, 6, None)] * 2


def test_who_was_skilled_sooner_counts_as_in_the_end_and_a_fifth_run_brings_intervals(plan):
    def make(job):
        return result(job, 2, 2, 20 - job.participant.number) if job.participant.number <= 5 else None

    [row, *_] = cell_rows(study(plan, make))
    assert row['success_after_3_episodes'] == row['success_in_the_end'] == pytest.approx(0.85)
    assert row['success_in_the_end_low'] < 0.85 < row['success_in_the_end_high']


def test_a_run_without_a_policy_by_then_counts_as_lost_in_success_and_error_alike(plan):
    """Whoever has held for longer than 10 s in the first episode has no policy by then, and is not left out."""
    def make(job):
        made = result(job, None, 4, 20, {checkpoint(1): 20, checkpoint(3): 20})
        if job.participant.number % 6 not in (1, 2):
            made.episodes[0]['seconds'] = 100.0
        return made

    found = study(plan, make)
    row = cell_rows(found)[0]
    assert row['success_after_10_human_seconds'] == pytest.approx(2 / 6)
    known = [1e3 * np.nan_to_num(abs(run.tests[checkpoint(3)].position_error), nan=0.2)[:, -150:].mean()
             for run in found.of('coached')[:2]]
    assert row['error_mm_after_10_human_seconds'] == pytest.approx((sum(known) + 4 * 200.0) / 6)


def test_what_is_not_known_of_one_run_is_not_told_of_the_others_alone(plan):
    def make(job):
        made = result(job, 2, 4, 20, {checkpoint(1): 20, checkpoint(3): 20})
        if job.name == 'coached/p01':  # as an older version left it
            del made.tests[checkpoint(3)]
            for episode in made.episodes:
                del episode['presses'], episode['noise_share']
        return made

    unknown, known, _ = cell_rows(study(plan, make))
    assert known['presses_to_skilled'] == 8.0
    for name in ('presses_to_skilled', 'noise_share_an_episode', 'success_after_3_episodes',
                 'error_mm_after_3_episodes', 'success_after_3_episodes_against_autonomous'):
        assert unknown[name] is unknown[f'{name}_low'] is None
    assert unknown['success_in_the_end'] == unknown['success_after_1_episodes'] == 1.0


def test_rows_can_be_written_and_read(plan):
    rows = cell_rows(study(plan, lambda job: result(job, None, 3, 0)))
    assert json.loads(json.dumps(rows, allow_nan=False)) == rows
    text = as_text(rows)
    assert len(text.splitlines()) == 4 and '0 of 6' in text and 'nobody' in text


def test_the_quick_form_is_one_participant_of_two_groups_and_three_episodes():
    whole, quick = load_plan(BASELINES), plan_of(read_plan(BASELINES, in_quick_form=True), BASELINES)
    assert {condition.preset for condition in whole.conditions} >= {
        'pd', 'lqr', 'identified_lqr', 'behaviour_cloning', 'hg_dagger', 'dcoach', 'sac_interventions', 'pvp',
        'autonomous', 'thesis', 'coached', 'guided'}
    assert [c.name for c in quick.conditions] == [c.name for c in whole.conditions]
    assert [c.sharing for c in quick.conditions] == [c.sharing for c in whole.conditions]
    assert [p.group for p in quick.participants] == ['reactive', 'crossover']
    assert all(c.episodes == c.evaluate_every <= 3 for c in quick.conditions)
    assert quick.tests == ('randomized',) and quick.checkpoints == () and whole.checkpoints == (2, 5, 10)


def test_a_plan_of_real_people_has_no_quick_form_and_no_cells(tmp_path, monkeypatch, capsys):
    path = tmp_path / 'plan.yaml'
    path.write_text(yaml.safe_dump({'participants': {'real': 2, 'consent': 'Yes.'}, 'conditions': {'coached': {}}}))
    with pytest.raises(PlanError, match=r'plan\.yaml: .*simulated'):
        read_plan(path, in_quick_form=True)
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(path), '--output', str(tmp_path), '--json', '-'])
    assert main() == 2 and '--json' in capsys.readouterr().err


def test_the_command_runs_a_plan_prints_its_cells_and_keeps_policies_on_the_way(tmp_path, monkeypatch, capfd):
    assert 'hg_dagger' in names(LEARNERS)
    path = tmp_path / 'plan.yaml'
    path.write_text("""
participants: {simulated: {bang_bang: 1}}
conditions: {hg_dagger: {episodes: 2, evaluate_every: 2, sharing: override}}
tests: [randomized]
checkpoints: [1]
""")
    folder = StudyFolder(tmp_path / 'study')
    monkeypatch.setattr('sys.argv', [
        'shared-control', 'study', str(path), '--output', str(folder.path), '--json', '-'])
    assert main() == 0
    said = capfd.readouterr()
    [cell] = json.loads(said.out)['cells']
    assert (cell['condition'], cell['tutor'], cell['runs']) == ('hg_dagger', 'bang_bang', 1)
    assert cell['presses_to_skilled'] is None and cell['interventions_an_episode'] > 0
    assert cell['noise_share_an_episode'] == 0.0
    assert 'hg_dagger/p01: not skilled' in said.err and 'learner' in said.err
    [job] = load_plan(path).jobs
    kept = load_result(folder.run(job))
    assert list(kept.tests) == ['randomized', checkpoint(1)] and len(kept.tests[checkpoint(1)].success) == 20
    assert [set(row) >= {'presses', 'interventions', 'noise_share'} for row in kept.episodes] == [True, True]
