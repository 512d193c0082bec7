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

"""The test on other arms, as a table and as a picture."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.figure import SubFigure
from matplotlib.ticker import NullFormatter
from shared_control_learning.evaluation.evaluate import SUCCESSES_NEEDED, TEST_EPISODES
from shared_control_learning.evaluation.result import TRANSFER, ProtocolResult
from shared_control_learning.evaluation.statistics import policy_figures

from ..plotting.plot import Plot
from ..plotting.style import AGENT, BAD


@dataclass(frozen=True)
class Row:
    """How policies did under one change."""

    change: str
    successes: tuple[float, ...]
    """Share of the episodes that succeeded, of each policy."""
    errors: tuple[float, ...]
    """Mean |position error| over the last 3 s, of each policy, m; until the ball fell."""

    @property
    def passed(self) -> int:
        """How many policies succeeded in 19 of 20."""
        return sum(success >= SUCCESSES_NEEDED / TEST_EPISODES for success in self.successes)


def rows(results: Mapping[str, Sequence[ProtocolResult]]) -> list[Row]:
    """A row a change: ``results`` of :func:`shared_control_learning.evaluation.transfer.run_transfer` by policy."""
    found = []
    for tests in zip(*results.values(), strict=True):
        figures = [policy_figures(test) for test in tests]
        found.append(Row(tests[0].test.removeprefix(TRANSFER), tuple(f['success'] for f in figures),
                         tuple(f['position_error_settled'] for f in figures)))
    return found


def transfer_table(results: Mapping[str, Sequence[ProtocolResult]]) -> str:
    """A line a change: success and error, over the policies when there are several."""
    several = len(results) > 1
    found = rows(results)
    width = max(len(row.change) for row in found)
    head = f'{"19 of 20":>9} {"success":>8} {"least":>6} {"|error| mm":>11} {"most":>7}' if several else (
        f'{"success":>8} {"|error| mm":>11}')
    lines = [f'On other arms: {len(results)} policies, medians over them; |error| over the last 3 s' if several else
             'On other arms: |error| over the last 3 s', f'  {"":<{width}} {head}']
    for row in found:
        success, error = f'{np.median(row.successes):>8.0%}', f'{1e3 * np.median(row.errors):>11.1f}'
        lines.append(f'  {row.change:<{width}} ' + (
            f'{f"{row.passed}/{len(results)}":>9} {success} {min(row.successes):>6.0%} {error} '
            f'{1e3 * max(row.errors):>7.1f}' if several else f'{success} {error}'))
    return '\n'.join(lines)


def transfer_plot(results: Mapping[str, Sequence[ProtocolResult]]) -> Plot:
    """Success and error by what was changed."""
    found = rows(results)
    policies = len(results)
    episodes = len(next(iter(results.values()))[0].success)
    return Plot('transfer', partial(_draw, found), (
        f'{"1 policy" if policies == 1 else f"{policies} policies"} on arms that are not as taught, {episodes} '
        'episodes each, by what was changed: episodes that succeed (left; dashed: 19 of 20), and mean |position error| '
        'over the last 3 s of each policy, until the ball fell (right; logarithmic).'), (7.1, 1.0 + 0.2 * len(found)))


def _draw(found: Sequence[Row], figure: SubFigure) -> None:
    policies = len(found[0].successes)
    left, right = figure.subplots(1, 2, sharey=True)
    places = np.arange(len(found))
    left.barh(places, [100 * np.mean(row.successes) for row in found], color=AGENT, height=0.6,
              label='mean success' if policies > 1 else 'success')
    left.axvline(100 * SUCCESSES_NEEDED / TEST_EPISODES, color=BAD, linewidth=1.2, linestyle='--', label='19 of 20')
    left.set(xlabel='Episodes that succeed (%)', xlim=(0, 100), yticks=places)
    left.set_yticklabels([row.change for row in found])
    left.invert_yaxis()
    for place, row in zip(places, found, strict=True):
        right.plot([1e3 * error for error in row.errors], [place] * policies, 'o', color=AGENT, markersize=4, alpha=0.6,
                   label='a policy' if place == 0 else None)
    right.set(xlabel='|position error| over the last 3 s (mm)', xscale='log')
    right.xaxis.set_major_formatter('{x:g}')
    right.xaxis.set_minor_formatter(NullFormatter())
    figure.legend(loc='outside lower center', ncols=4)
