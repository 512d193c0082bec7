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

"""The tables of a study's report."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from shared_control_learning.evaluation.result import TRANSFER

from .measures import Study, times, transfers
from .statistics import Estimate, beats, bootstrap, improvement, sooner, survival


@dataclass(frozen=True)
class Measure:
    """A column of the table of runs."""

    column: str
    label: str
    unit: str
    lower_is_better: bool = True


MEASURES = (
    Measure('success', 'Randomised test: episodes that succeed', '%', lower_is_better=False),
    Measure('kept', 'All tests: episodes in which the ball is kept', '%', lower_is_better=False),
    Measure('alone_error', 'Randomised test: |position error| of the last 3 s', 'cm'),
    Measure('pushed_error', 'Perturbation test: |position error|', 'cm'),
    Measure('pushed_kept', 'Perturbation test: ball kept', '%', lower_is_better=False),
    Measure('moving_error', 'Trajectory tests: |position error|', 'cm'),
    Measure('moving_kept', 'Trajectory tests: ball kept', '%', lower_is_better=False),
    Measure('elsewhere', 'On other arms: episodes that succeed', '%', lower_is_better=False),
    Measure('workload', 'Workload (raw NASA-TLX)', '0-100'),
)
"""What conditions are compared by, beside the episodes to skilled. A ball that fell lies where the tray ends."""


def conditions_table(study: Study, runs: pd.DataFrame) -> pd.DataFrame:
    """A row a condition and measure: estimate and 95 % interval.

    The interquartile mean, but for episodes to skilled the median of Kaplan and Meier.
    """
    rows = []
    for condition in study.conditions:
        reached = times(study.of(condition))
        skilled = (f'{reached.reached.sum()} of {len(reached.reached)} skilled')
        rows.append(_row(condition, 'Episodes to skilled (median)', '', survival(reached).median, skilled))
        own = runs[runs.condition == condition]
        for measure in _present(own):
            known = own.dropna(subset=[measure.column])
            scale = 100 if measure.unit == '%' else 1
            # Shares are means: the middle half of 1, 1, 1 and 0 would hide the 0.
            statistic: dict = {'statistic': lambda rows: rows.mean(axis=-1)} if measure.unit == '%' else {}
            estimate = bootstrap(scale * known[measure.column].to_numpy(float), known.group.to_numpy(), **statistic)
            rows.append(_row(condition, measure.label, measure.unit, estimate, runs_in_words(len(known))))
    return pd.DataFrame(rows)


def comparison_table(study: Study, runs: pd.DataFrame) -> pd.DataFrame:
    """A row for every two conditions and measure: the probability that the first is better.

    Than the second, for the same participant: runs are paired by participant and so by seed. Conditions of different
    tasks are not compared.
    """
    rows = []
    for first, second in combinations(study.conditions, 2):
        if study.task(first).name != study.task(second).name:
            continue
        one, other = ({run.participant: run for run in study.of(name)} for name in (first, second))
        both = sorted(one.keys() & other.keys())
        if not both:
            continue
        groups = np.array([one[number].group for number in both])
        better = sooner(times([one[number] for number in both]), times([other[number] for number in both]))
        rows.append(_pair(first, second, 'Episodes to skilled', improvement(better, groups), len(both)))
        for measure in _present(runs):
            rows += _compare(first, second, measure, runs)
    return pd.DataFrame(rows)


def transfer_table(study: Study) -> pd.DataFrame:
    """A row for every condition and arm that is not as taught: share of the episodes that succeed, over the runs.

    Runs without a policy succeed on none of the arms of the others.
    """
    arms = dict.fromkeys(test.test for run in study.runs for test in transfers(run))
    return pd.DataFrame([
        {'condition': condition, 'change': arm.removeprefix(TRANSFER), 'run': run.participant,
         'success': float(run.tests[arm].success.mean()) if run.episodes else 0.0}
        for condition in study.conditions for run in study.of(condition) for arm in arms
        if arm in run.tests or not run.episodes],
        columns=['condition', 'change', 'run', 'success']).groupby(
            ['condition', 'change'], sort=False, as_index=False).agg(runs=('run', 'size'), success=('success', 'mean'))


def group_table(runs: pd.DataFrame) -> pd.DataFrame:
    """A row for every condition, group of participants and quantity of 4.4 and 4.5."""
    quantities = {'human_variance': ("Variance of the human's moment within an episode", '(N m)²'),
                  'agent_variance': ("Variance of the robot's moment within an episode", '(N m)²'),
                  'pushed_error': ('Perturbation test: |position error|', 'cm')}
    rows = []
    for (condition, group), own in runs[runs.taught].groupby(['condition', 'group'], sort=False):
        for column, (label, unit) in quantities.items():
            if column in own and len(known := own.dropna(subset=[column])):
                estimate = bootstrap(known[column].to_numpy(float), np.zeros(len(known)))
                rows.append({'group': group, **_row(condition, label, unit, estimate, runs_in_words(len(known)))})
    return pd.DataFrame(rows)


def _compare(first: str, second: str, measure: Measure, runs: pd.DataFrame) -> list[dict]:
    table = runs.pivot(index='participant', columns='condition', values=measure.column)
    if not {first, second} <= set(table.columns):
        return []
    pairs = table[[first, second]].dropna()
    if pairs.empty:
        return []
    groups = runs.drop_duplicates('participant').set_index('participant').group[pairs.index].to_numpy()
    better = beats(pairs[first].to_numpy(float), pairs[second].to_numpy(float), measure.lower_is_better)
    return [_pair(first, second, measure.label, improvement(better, groups), len(pairs))]


def _present(runs: pd.DataFrame) -> list[Measure]:
    return [measure for measure in MEASURES if measure.column in runs and runs[measure.column].notna().any()]


def _row(condition: str, label: str, unit: str, estimate: Estimate, basis: str) -> dict:
    return {'condition': condition, 'measure': label, 'unit': unit, 'value': estimate.value, 'low': estimate.low,
            'high': estimate.high, 'basis': basis}


def runs_in_words(count: int) -> str:
    """How many runs."""
    return '1 run' if count == 1 else f'{count} runs'


def _pair(first: str, second: str, label: str, estimate: Estimate, pairs: int) -> dict:
    return {'first': first, 'second': second, 'measure': label, 'probability': estimate.value, 'low': estimate.low,
            'high': estimate.high, 'pairs': pairs}
