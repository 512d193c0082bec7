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

"""Statistics of a study, and its report."""

import csv
import json
import re
from datetime import date
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from shared_control.cli import main
from shared_control_records.study.folder import StudyFolder
from shared_control_records.study.notes import add_note
from shared_control_records.study.result import RESULT, TESTS
from shared_control_records.study_report import report
from shared_control_records.study_report.measures import away, load_study, run_table
from shared_control_records.study_report.report import write_study_report
from shared_control_records.study_report.statistics import Times, beats, bootstrap, improvement, iqm, sooner, survival
from shared_control_records.study_report.tables import comparison_table, conditions_table, transfer_table
from shared_control_testing.studies import made_study

PLAN = """
participants: {simulated: {expert: 2, high: 3, low: 3}}
conditions: {coached: {episodes: 20}, autonomous: {episodes: 40, taught: false}}
"""


@pytest.fixture(scope='module')
def plan(tmp_path_factory):
    path = tmp_path_factory.mktemp('plan') / 'plan.yaml'
    path.write_text(PLAN)
    return path


@pytest.fixture(scope='module')
def folder(plan, tmp_path_factory):
    return made_study(tmp_path_factory.mktemp('made') / 'study', plan)


def test_the_interquartile_mean_is_that_of_the_middle_half():
    assert iqm(np.array([-1e6, 1.0, 2.0, 1e6])) == 1.5
    assert iqm(np.arange(8.0)) == pytest.approx(np.mean([2, 3, 4, 5]))


def test_a_stratified_bootstrap_never_mixes_groups():
    """Nearly all spread lies between the groups, so whoever resamples within them finds little."""
    values, groups = np.repeat([0.0, 10.0], 6) + np.tile([-0.1, 0.1], 6), np.repeat(['low', 'high'], 6)
    estimate = bootstrap(values, groups, lambda rows: rows.mean(axis=-1))
    assert 4.9 < estimate.low < estimate.value < estimate.high < 5.1
    pooled = bootstrap(values, np.zeros(12), lambda rows: rows.mean(axis=-1))
    assert pooled.low < 4.0 < 6.0 < pooled.high


def test_the_bootstrap_covers_the_truth_as_often_as_it_says():
    random = np.random.default_rng(1)
    covered = 0
    for trial in range(200):
        estimate = bootstrap(random.normal(3.0, 1.0, 24), np.zeros(24), lambda rows: rows.mean(axis=-1), seed=trial)
        covered += estimate.low <= 3.0 <= estimate.high
    assert 180 <= covered <= 199


def test_two_experts_among_many_take_no_interval_away():
    """As studies/thesis.yaml has them; nearly as wide as if all were one group."""
    values, groups = np.random.default_rng(0).normal(3.0, 1.0, 24), np.repeat(['expert', 'high', 'low'], [2, 11, 11])
    whole = bootstrap(values, np.zeros(24))
    within = bootstrap(values, groups)
    assert within.low < within.value < within.high
    assert within.high - within.low == pytest.approx(whole.high - whole.low, rel=0.2)


def test_few_or_equal_values_have_no_interval_that_looks_certain():
    few = bootstrap(np.array([1.0, 2.0, 3.0, 4.0]), np.zeros(4))
    assert few.value == 2.5 and np.isnan([few.low, few.high]).all()
    each_alone = bootstrap(np.arange(8.0), np.arange(8))
    assert each_alone.value == 3.5 and np.isnan([each_alone.low, each_alone.high]).all()
    always = improvement(np.ones(8), np.zeros(8))
    assert always.value == 1.0 and np.isnan([always.low, always.high]).all()
    pair = survival(Times(np.array([3.0, 5.0]), np.array([True, True])))
    assert pair.median.value == 3.0 and np.isnan([pair.median.low, pair.median.high]).all()
    assert np.isnan(pair.low[1:]).all()


def test_survival_counts_who_was_given_up():
    curve = survival(Times(np.array([3.0, 5.0, 5.0, 8.0, 20.0, 20.0]), np.array([1, 1, 1, 1, 0, 0], bool)))
    assert curve.episodes.tolist() == [0, 3, 5, 8, 20]
    assert curve.waiting == pytest.approx([1, 5 / 6, 1 / 2, 1 / 3, 1 / 3])
    assert curve.median.value == 5.0 and curve.median.low == 3.0 and np.isinf(curve.median.high)
    assert (curve.low <= curve.waiting).all() and (curve.waiting <= curve.high).all()
    early = survival(Times(np.array([3.0, 5.0, 5.0, 8.0, 20.0, 2.0]), np.array([1, 1, 1, 1, 0, 0], bool)))
    assert early.median.value == 5.0, 'who was given up early says nothing of later'
    assert early.waiting[early.episodes == 5.0] == pytest.approx(2 / 5)
    never = survival(Times(np.array([20.0, 20.0]), np.array([False, False])))
    assert np.isinf(never.median.value)


@pytest.mark.parametrize(('episodes', 'interval'), [
    (6 * [2.0], None), (24 * [2.0], None), (12 * [2.0] + 12 * [3.0], (2.0, 3.0)),
    ([3.0, 4.0, 5.0, 6.0, 7.0], (3.0, 7.0))])
def test_an_interval_has_an_end_where_everybody_got_there(episodes, interval):
    curve = survival(Times(np.array(episodes), np.ones(len(episodes), bool)))
    assert curve.median.value == np.quantile(episodes, 0.5, method='inverted_cdf')
    assert np.isnan([curve.median.low, curve.median.high]).all() if interval is None else (
        curve.median.low, curve.median.high) == interval
    assert curve.waiting[-1] == 0.0 and np.isnan([curve.low[-1], curve.high[-1]]).all()


def test_who_was_sooner_is_a_tie_where_nobody_knows():
    first = Times(np.array([3.0, 20.0, 20.0, 9.0, 20.0]), np.array([1, 0, 0, 1, 0], bool))
    second = Times(np.array([9.0, 12.0, 40.0, 9.0, 30.0]), np.array([1, 1, 0, 1, 1], bool))
    assert sooner(first, second).tolist() == [1.0, 0.0, 0.5, 0.5, 0.5]
    assert sooner(second, first).tolist() == [0.0, 1.0, 0.5, 0.5, 0.5]
    assert beats(np.array([1.0, 2.0, 2.0]), np.array([2.0, 1.0, 2.0]), lower_is_better=True).tolist() == [1, 0, 0.5]
    assert improvement(np.array([1.0, 1.0]), np.zeros(2)).value == 1.0


@pytest.mark.parametrize(('alone', 'task', 'saved'), [
    ('autonomous', 'balance', True), ('coached', 'balance', True), ('lqr', 'balance', False),
    ('autonomous', 'plate', False)])
def test_what_teaching_saves_is_told_against_the_same_task_learned_alone(tmp_path, alone, task, saved):
    (tmp_path / 'plan.yaml').write_text(
        'seed: 1\nparticipants: {simulated: {expert: 6}}\ntests: [randomized]\nconditions:\n'
        '  taught: {preset: coached, episodes: 20}\n'
        f'  alone: {{preset: {alone}, task: {task}, taught: false, episodes: 40}}\n')
    study = load_study(made_study(tmp_path / 'study', tmp_path / 'plan.yaml'))
    assert [name for name, _ in report._reduction(study)] == ['taught'] * saved
    assert len(comparison_table(study, run_table(study))) == 0 or task == 'balance'


@pytest.mark.parametrize(('change', 'said'), [
    ({'participant': 2}, 'is of another run: participant is 2, not 1'), ({'seed': 99}, 'seed is 99'),
    ({'skilled': 99}, r'damaged \(skilled after 99 of'),
    ({'episodes': [{'episode': 1.0}], 'skilled': None}, 'no number seconds')])
def test_a_result_of_another_run_is_left_out_and_said(plan, tmp_path, change, said):
    made = made_study(tmp_path / 'study', plan)
    first = load_study(made)
    path = made.run(first.plan.jobs[0]) / 'result.json'
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    study = load_study(made)
    assert len(study.runs) == len(first.runs) - 1
    [problem] = study.problems
    assert str(path.parent) in problem and re.search(said, problem)


def test_a_report_replaces_no_other_files(folder, tmp_path):
    (tmp_path / 'report.html').write_text('of a session')
    (tmp_path / 'settings.json').write_text('{}')
    with pytest.raises(OSError, match=r'holds settings\.json, which is of no'):
        write_study_report(folder, tmp_path)
    assert (tmp_path / 'report.html').read_text() == 'of a session'


def test_tables_count_every_run(folder):
    study = load_study(folder)
    runs = run_table(study)
    assert len(runs) == 16
    conditions = conditions_table(study, runs).set_index(['condition', 'measure'])
    reached = sum(run.skilled is not None for run in study.of('autonomous'))
    assert conditions.loc[('autonomous', 'Episodes to skilled (median)'), 'basis'] == f'{reached} of 8 skilled'
    comparisons = comparison_table(study, runs)
    assert set(comparisons.pairs) == {8}
    assert comparisons.probability.between(0, 1).all()
    assert comparisons.set_index('measure').probability['Episodes to skilled'] == 1.0


def test_the_report_is_one_page_with_its_figures_and_numbers(folder, tmp_path):
    page = write_study_report(folder, tmp_path / 'report').read_text()
    assert page.index('All participants were simulated') < page.index('In short')
    figures = sorted(path.stem for path in (tmp_path / 'report/figures').glob('*.svg'))
    assert [int(name[3:5]) for name in figures] == list(range(14, 25))
    for kind in ('png', 'pdf'):
        assert figures == sorted(path.stem for path in (tmp_path / 'report/figures').glob(f'*.{kind}'))
    assert page.count('<figcaption>') == 11 and page.count('<caption>') == 4
    assert f'shared-control {version("shared-control")} · seed 0 · {date.today():%Y-%m-%d}</footer>' in page
    assert page.count('src="data:image/svg+xml;base64,') == 11
    assert not re.search(r'(src|href)="(?!data:)', page), 'needs no other file'
    for name in (*figures, 'runs', 'conditions', 'comparisons', 'groups', 'cells'):
        with (tmp_path / f'report/data/{name}.csv').open() as file:
            assert len(list(csv.DictReader(file))) > 1
    with (tmp_path / 'report/data/fig16_randomized_position.csv').open() as file:
        rows = [row for row in csv.DictReader(file) if row['policies'] == 'All' and row['condition'] == 'coached']
    starts = [100 * run.tests['randomized'].position_error[:, 0].mean() for run in load_study(folder).of('coached')]
    assert len(rows) == 500 and rows[0]['n'] == '8'
    assert float(rows[0]['mean']) == pytest.approx(np.mean(starts), rel=1e-4)
    assert float(rows[0]['sem']) == pytest.approx(np.std(starts, ddof=1) / np.sqrt(8), rel=1e-4)


def test_what_is_unfinished_or_damaged_is_left_out_and_said(plan, tmp_path, monkeypatch, capsys):
    folder = made_study(tmp_path / 'study', plan, missing=2)
    damaged, torn, wrong = (folder.path / 'runs/autonomous' / label for label in ('p01', 'p02', 'p03'))
    (damaged / TESTS).write_bytes(b'PK\x03\x04 half a zip')
    (torn / RESULT).unlink()
    content = json.loads((wrong / RESULT).read_text())
    (wrong / RESULT).write_text(json.dumps({**content, 'seconds': 'many'}))
    study = load_study(folder)
    assert len(study.runs) == 11
    assert len(study.problems) == 2 and str(damaged) in study.problems[0]
    assert str(wrong) in study.problems[1] and 'seconds: Input should be a valid number' in study.problems[1]

    empty = StudyFolder(tmp_path / 'empty')
    empty.begin(plan)
    monkeypatch.setattr('sys.argv', ['shared-control', 'report', str(empty.path)])
    assert main() == 2
    assert f'no run of the study in {Path(empty.path)} is done yet' in capsys.readouterr().err


@pytest.mark.parametrize(('task', 'lost'), [
    ('balance', 0.2), ('plate', 0.15 * 2 ** 0.5), ('detour', np.hypot(0.21, 0.23))])
def test_a_ball_that_fell_lies_where_the_tray_of_its_task_ends(tmp_path, task, lost):
    path = tmp_path / 'plan.yaml'
    path.write_text(PLAN.replace('episodes: 20', f'episodes: 20, task: {task}'))
    study = load_study(made_study(tmp_path / 'study', path))
    run = study.of('coached')[0]
    assert study.task('coached').name == task and study.task('autonomous').name == 'balance'
    assert study.lost(run) == pytest.approx(lost, abs=1e-6)
    test = run.tests['randomized']
    test.position_error[:] = np.nan
    assert away(test, study.lost(run)).max() == pytest.approx(lost)


def test_success_on_other_arms_is_a_measure_and_a_table_by_what_was_changed(tmp_path):
    (tmp_path / 'plan.yaml').write_text(PLAN + 'tests: [randomized, transfer]\n')
    study = load_study(made_study(tmp_path / 'study', tmp_path / 'plan.yaml'))
    runs = run_table(study)
    assert 'On other arms: episodes that succeed' in set(conditions_table(study, runs).measure)
    rows = transfer_table(study).to_dict('records')
    assert [(row['condition'], row['change'], row['runs']) for row in rows] == [
        ('coached', 'ball of 0.6 kg', 8), ('autonomous', 'ball of 0.6 kg', 8)]
    for row in rows:
        assert row['success'] == pytest.approx(runs[runs.condition == row['condition']].elsewhere.mean())
    assert set(runs.elsewhere) <= {0.0, 1.0}


def test_who_is_left_out_by_the_experimenter_is_in_no_figure_and_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(report, 'draw_all', lambda study: [])  # it takes its time
    (tmp_path / 'plan.yaml').write_text(
        'participants: {real: 3, consent: "Yes?"}\nconditions: {coached: {episodes: 20}}')
    folder = made_study(tmp_path / 'study', tmp_path / 'plan.yaml')
    add_note(folder.path / 'people' / 'p02', 'exclude', 'knew the <plan>')
    study = load_study(folder)
    assert [run.participant for run in study.runs] == [1, 3] and study.missing == 0
    page = write_study_report(folder, tmp_path / 'report').read_text()
    assert re.search(r'participant\s+2: knew the &lt;plan&gt;', page) and 'runs are done' not in page
    assert str(tmp_path) not in page and not (tmp_path / 'report/data/cells.csv').exists()
    assert 'if it then passed. Runs that never got there' in ' '.join(page.split())
