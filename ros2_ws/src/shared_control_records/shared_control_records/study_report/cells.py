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

"""A study cell by cell: each condition with each group of tutors, in the figures that the field reports.

Every figure has its 95 % interval (:mod:`.statistics`). Runs that never got there are censored where times are told,
and count like all others elsewhere; what is not known of one of them is not known of the row, which would else be of
the others alone. Conditions are compared with :data:`AGAINST`, in pairs of the same seed.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from shared_control_learning.evaluation.result import checkpoint

from ..study.result import RunResult
from .measures import Study, away, times
from .statistics import Estimate, Times, bootstrap, sooner, survival

AGAINST = 'autonomous'
"""The condition that others are compared with, where a study has it."""
NOBODY = 'nobody'
"""The tutor of conditions that are not taught."""
HUMAN_SECONDS = (10, 30, 60)
"""Seconds of held moments after which policies are compared."""

Row = dict[str, float | int | str | None]
_UNKNOWN = Estimate(math.nan, math.nan, math.nan)


def cell_rows(study: Study) -> list[Row]:
    """A row for each condition and group of simulated participants, in the plan's order.

    What is infinite, or is not known of one of the runs, is None.
    A figure that is estimated has its interval under its name with ``_low`` and ``_high``.
    """
    rows = []
    for condition in study.plan.conditions:
        runs = study.of(condition.name)
        groups = {run.group if condition.taught else NOBODY: None for run in runs}
        for group in groups:
            rows.append(_row(study, condition.name, group, [
                run for run in runs if group in (NOBODY, run.group)]))
    return rows


def _row(study: Study, condition: str, group: str, runs: list[RunResult]) -> Row:
    reached = times(runs)
    row: Row = {'condition': condition, 'tutor': group, 'runs': len(runs), 'skilled': int(reached.reached.sum()),
                'slowest': float(reached.episodes.max()) if reached.reached.all() else None}
    costs = {'episodes': reached, 'robot_seconds': _when(runs, lambda row: row['seconds']),
             'human_seconds': _when(runs, human_seconds),
             'presses': _when(runs, lambda row: row.get('presses', math.nan))}
    for name, when in costs.items():
        row |= _named(f'{name}_to_skilled', survival(when).median if np.isfinite(when.episodes).all() else _UNKNOWN)
    for name in ('interventions', 'noise_share'):
        row |= _mean(f'{name}_an_episode', [
            float(np.mean([episode.get(name, math.nan) for episode in run.episodes])) for run in runs])
    moments: dict[str, Callable[[RunResult], str | None]] = {
        **{f'after_{number}_episodes': partial(_test_after, number) for number in study.plan.checkpoints},
        **{f'after_{seconds}_human_seconds': partial(_test_within, study, seconds)
           for seconds in HUMAN_SECONDS if study.plan.checkpoints},
        'in_the_end': lambda run: 'randomized'}
    pairs = _paired(study, condition, runs)
    for name, test in moments.items():
        row |= _mean(f'success_{name}', [_success(run, test(run)) for run in runs])
        row |= _mean(f'error_mm_{name}', [_error(study, run, test(run)) for run in runs])
        row |= _mean(f'success_{name}_against_{AGAINST}', [
            _success(run, test(run)) - _success(other, test(other)) for run, other in pairs])
    if pairs:
        mine, theirs = zip(*pairs, strict=True)
        row |= _mean(f'sooner_than_{AGAINST}', list(sooner(times(list(mine)), times(list(theirs)))))
    return row


def human_seconds(row: dict[str, Any]) -> float:
    """How long the human held a moment in an episode of a run, s."""
    return row['seconds'] * row['intervention_rate']


def _when(runs: list[RunResult], cost: Callable[[dict[str, Any]], float]) -> Times:
    """What it had cost when the runs were skilled, or ended; nan where an episode does not tell."""
    return Times(np.array([sum(map(cost, run.episodes[:run.skilled])) for run in runs], float),
                 np.array([run.skilled is not None for run in runs], bool))


def _test_after(episodes: int, run: RunResult) -> str | None:
    """The test of the policy after so many episodes; the last one of a run that ended sooner."""
    return 'randomized' if episodes >= len(run.episodes) else checkpoint(episodes)


def _test_within(study: Study, seconds: float, run: RunResult) -> str | None:
    """The last test before the human had held a moment for longer than so; None when there was none by then."""
    spent = np.cumsum([human_seconds(row) for row in run.episodes])
    known = [number for number in (*study.plan.checkpoints, len(run.episodes))
             if number <= len(run.episodes) and spent[number - 1] <= seconds]
    return _test_after(max(known), run) if known else None


def _success(run: RunResult, test: str | None) -> float:
    """Share of successes; 0 where there was no policy yet."""
    if test is None:
        return 0.0
    return float(run.tests[test].success.mean()) if test in run.tests else math.nan


def _error(study: Study, run: RunResult, test: str | None) -> float:
    """Mean |position error| over the last 3 s, mm; a ball that fell, or had no policy yet, lies where the tray ends."""
    if test is None:
        return 1e3 * study.lost(run)
    if test not in run.tests:
        return math.nan
    return 1e3 * float(away(run.tests[test], study.lost(run))[:, -150:].mean())


def _paired(study: Study, condition: str, runs: list[RunResult]) -> list[tuple[RunResult, RunResult]]:
    """Runs, each with that of the same participant in :data:`AGAINST`."""
    others = {run.participant: run for run in study.of(AGAINST)} if condition != AGAINST else {}
    return [(run, others[run.participant]) for run in runs if run.participant in others]


def _mean(name: str, values: list[float]) -> Row:
    found = np.array(values)
    return _named(name, bootstrap(found, np.zeros(len(found)), lambda rows: rows.mean(axis=-1))
                  if np.isfinite(found).all() else _UNKNOWN)


def _named(name: str, estimate: Estimate) -> Row:
    return {key: float(value) if math.isfinite(value) else None for key, value in (
        (name, estimate.value), (f'{name}_low', estimate.low), (f'{name}_high', estimate.high))}


_COLUMNS = (
    ('learner', 18), ('tutor', 12), ('skilled', 9), ('  episodes', 14), ('robot s', 8), ('human s', 8), ('presses', 8),
    ('interv.', 8), ('noise', 6), ('success', 8), ('error mm', 9))


def as_text(rows: list[Row]) -> str:
    """The main figures as a table for a terminal: medians until skilled, then means."""
    lines = [''.join(f'{title:<{width}}' if width > 9 else f'{title:>{width}}' for title, width in _COLUMNS)]
    for row in rows:
        episodes = _text(row['episodes_to_skilled'])
        if row['episodes_to_skilled_low'] is not None or row['episodes_to_skilled_high'] is not None:
            episodes += f' [{_text(row["episodes_to_skilled_low"])}, {_text(row["episodes_to_skilled_high"])}]'
        cells = [row['condition'], row['tutor'], f'{row["skilled"]} of {row["runs"]}', f'  {episodes}', *(
            _text(row[f'{name}_to_skilled']) for name in ('robot_seconds', 'human_seconds', 'presses')),
            _text(row['interventions_an_episode']), _text(row['noise_share_an_episode'], '.0%'),
            _text(row['success_in_the_end'], '.0%'), _text(row['error_mm_in_the_end'])]
        lines.append(''.join(f'{cell:<{width}}' if width > 9 else f'{cell:>{width}}'
                             for cell, (_, width) in zip(cells, _COLUMNS, strict=True)))
    return '\n'.join(lines)


def _text(value: Any, form: str = '.3g') -> str:
    return '-' if value is None else format(value, form)
