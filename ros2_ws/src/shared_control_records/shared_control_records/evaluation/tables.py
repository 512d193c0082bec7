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

"""What the tests found, to read and as files."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from shared_control.files import write_atomically
from shared_control_learning.evaluation.result import TRACKS, ProtocolResult
from shared_control_learning.evaluation.statistics import FIGURES, curve, episode_figures, mean_and_sem, policy_figures

Results = Mapping[str, Sequence[ProtocolResult]]
"""The results of a protocol by policy: one a test, in the same order for all."""

_COLUMNS: dict[str, tuple[str, float, str]] = {
    'position_error': ('|error| mm', 1e3, '.1f'), 'position_error_max': ('largest', 1e3, '.1f'),
    'position_error_settled': ('last 3 s', 1e3, '.2f'), 'velocity_error': ('|velocity| mm/s', 1e3, '.1f'),
    'velocity_error_settled': ('last 3 s', 1e3, '.2f'), 'agent_moment': ('|M_yai| N m', 1.0, '.2f'),
    'k_w': ('k_w', 1.0, '.4f'), 'one_minus_k_w_squared': ('1 - k_w^2', 1.0, '.4f')}
"""Head, factor and format of a column, by the name of its figure."""


def by_test(results: Results) -> dict[str, list[ProtocolResult]]:
    """The results of all policies by test."""
    return {tests[0].test: list(tests) for tests in zip(*results.values(), strict=True)}


def text_table(results: Results) -> str:
    """A table a test: a row a policy, and mean and SEM over the policies when there are several."""
    width = max(len('± SEM'), *map(len, results))
    lines = []
    for test, tests in by_test(results).items():
        lines += ['', f'{test}: means over the episodes, until the ball fell',
                  f'  {"":<{width}} {"kept":>7} {"success":>8} '
                  + ' '.join(f'{head:>{_width(head)}}' for head, _, _ in _COLUMNS.values())]
        rows = [policy_figures(result) for result in tests]
        for name, result, row in zip(results, tests, rows, strict=True):
            count = len(result.fallen)
            kept, success = (f'{round(count * row[key])}/{count}' for key in ('kept', 'success'))
            lines.append(f'  {name:<{width}} {kept:>7} {success:>8} {_row(row)}')
        if len(rows) > 1:
            for name, row in zip(('mean', '± SEM'), _over_policies(rows), strict=True):
                lines.append(f'  {name:<{width}} {row["kept"]:>7.0%} {row["success"]:>8.0%} {_row(row)}')
    return '\n'.join(lines[1:])


def as_json(results: Results) -> dict[str, Any]:
    """All figures, SI units: of each episode, each policy, and over the policies."""
    content: dict[str, Any] = {'figures': FIGURES, 'tests': {}}
    for test, tests in by_test(results).items():
        rows = [policy_figures(result) for result in tests]
        mean, sem = _over_policies(rows)
        content['tests'][test] = {
            'policies': {name: {'mean': row, 'episodes': episode_figures(result)}
                         for name, result, row in zip(results, tests, rows, strict=True)},
            'over_policies': {'count': len(rows), 'mean': mean, 'sem': sem if len(rows) > 1 else None}}
    return content


def slug(test: str) -> str:
    """The name of a test as a part of file names."""
    return re.sub(r'[^a-z0-9.+-]+', '_', test.lower())


def write_csv(results: Results, protocol: str, folder: Path) -> None:
    """``PROTOCOL_episodes.csv``, a row an episode; and for each test its tracks and their mean and SEM over time.

    Files are called by the protocol or the test: those of others may be in the folder, and those of a training run.
    """
    episodes = [
        {'test': result.test, 'policy': name, 'episode': number, **figures}
        for name, tests in results.items() for result in tests
        for number, figures in enumerate(episode_figures(result), start=1)]
    _write(pd.DataFrame(episodes), folder / f'{protocol}_episodes.csv')
    for test, tests in by_test(results).items():
        _write(pd.concat([_tracks(name, result) for name, result in zip(results, tests, strict=True)]),
               folder / f'{slug(test)}_tracks.csv')
        means = {'seconds': tests[0].seconds}
        for track in TRACKS:
            means[f'{track}_mean'], means[f'{track}_sem'] = curve(tests, track)
            means[f'abs_{track}_mean'], means[f'abs_{track}_sem'] = curve(tests, track, absolute=True)
        _write(pd.DataFrame(means), folder / f'{slug(test)}_mean.csv')


def _tracks(name: str, result: ProtocolResult) -> pd.DataFrame:
    """A row a sample, of the time before the ball fell."""
    episodes, steps = result.position_error.shape
    return pd.DataFrame({
        'policy': name, 'episode': np.repeat(np.arange(1, episodes + 1), steps),
        'seconds': np.tile(result.seconds, episodes),
        **{track: getattr(result, track).ravel() for track in TRACKS}}).dropna()


def _write(table: pd.DataFrame, path: Path) -> None:
    write_atomically(path, table.to_csv(index=False, float_format='%.6g').encode())


def _over_policies(rows: Sequence[Mapping[str, float]]) -> tuple[dict[str, float], dict[str, float]]:
    means, sems = mean_and_sem(np.array([[row[name] for name in FIGURES] for row in rows]))
    return dict(zip(FIGURES, means.tolist(), strict=True)), dict(zip(FIGURES, sems.tolist(), strict=True))


def _row(figures: Mapping[str, float]) -> str:
    return ' '.join(f'{factor * figures[name]:>{_width(head)}{form}}'
                    for name, (head, factor, form) in _COLUMNS.items())


def _width(head: str) -> int:
    return max(len(head), 8)
