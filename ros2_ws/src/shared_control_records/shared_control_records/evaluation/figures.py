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

"""Figs. 16-19 and 22-24 of the thesis, for one condition."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from shared_control_learning.evaluation.perturbation import PUSHES
from shared_control_learning.evaluation.result import ProtocolResult
from shared_control_learning.evaluation.statistics import curve

from ..plotting.plot import Plot
from ..plotting.style import AGENT, FAINT, GOOD, HUMAN
from ..study_report.statistics import ENOUGH
from .tables import slug

NUMBERS = {'randomized': (16, 17), 'perturbation': (18, 19), 'trajectory 0.25 Hz': (22, 22),
           'trajectory 0.5 Hz': (23, 23), 'trajectory 1 Hz': (24, 24)}
"""The thesis' figures of position and velocity error, by test."""
SIZE = (7.1, 4.6)
"""inches"""


def plots(results: Sequence[ProtocolResult]) -> Iterator[Plot]:
    """The figures of one test.

    Args:
        results: of the test, one a policy.
    """
    test = results[0].test
    stem = slug(test)
    position, velocity = NUMBERS[test]
    if position == velocity:
        yield Plot(f'fig{position}_{stem}', partial(_draw_both, results),
                   _caption(results, 'Position error (top) and velocity error (bottom)'), SIZE)
    else:
        for number, track, what in ((position, 'position_error', 'Position error'),
                                    (velocity, 'velocity_error', 'Velocity error')):
            yield Plot(f'fig{number}_{stem}_{track}', partial(_draw_error, results, track), _caption(
                results, f'{what} (top) and its magnitude (bottom), since errors of both signs cancel in a mean'), SIZE)
    yield Plot(f'{stem}_manipulability', partial(_draw_manipulability, results), _caption(
        results, 'Manipulability of Yoshikawa, k_w (equation 34), and 1 - k_w^2 as the appendix of the thesis has it; '
                 'both without unit'), SIZE)


def _caption(results: Sequence[ProtocolResult], what: str) -> str:
    """A caption: the test, what is drawn, of how many, and what the band is."""
    fallen = sum(int(result.fallen.sum()) for result in results)
    episodes = sum(len(result.fallen) for result in results)
    parts = [f'Test {results[0].test}: {"1 policy" if len(results) == 1 else f"{len(results)} policies"}, '
             f'{episodes} episode{"" if episodes == 1 else "s"}.', f'{what}.']
    if _averaged(results) > 1:
        band = '; band: plus and minus its standard error' if _averaged(results) >= ENOUGH else ''
        parts.append(f'Line: mean over {"policies" if len(results) > 1 else "episodes"}{band}.')
    if fallen:
        parts.append(f'The ball fell in {fallen}; an episode counts until then.')
    if results[0].test == 'perturbation':
        parts.append('Shaded: 50 N pushes.')
    return ' '.join(parts)


def _averaged(results: Sequence[ProtocolResult]) -> int:
    """How many a mean is over: policies, or the episodes of one."""
    return len(results) if len(results) > 1 else len(results[0].fallen)


_LABELS = {'position_error': ('Position error (cm)', 100.0), 'velocity_error': ('Velocity error (cm/s)', 100.0)}


def _draw_error(results: Sequence[ProtocolResult], track: str, figure: SubFigure) -> None:
    """The error as it is above, its magnitude below: errors of both signs cancel in a mean."""
    top, bottom = figure.subplots(2, 1, sharex=True)
    _draw_curve(top, results, track, absolute=False)
    _draw_curve(bottom, results, track, absolute=True)
    bottom.set_xlabel('Time (s)')
    bottom.set_ylim(bottom=0)
    _legend(figure)


def _draw_both(results: Sequence[ProtocolResult], figure: SubFigure) -> None:
    top, bottom = figure.subplots(2, 1, sharex=True)
    _draw_curve(top, results, 'position_error', absolute=False)
    _draw_curve(bottom, results, 'velocity_error', absolute=False, colour=HUMAN)
    bottom.set_xlabel('Time (s)')
    _legend(figure)


def _draw_manipulability(results: Sequence[ProtocolResult], figure: SubFigure) -> None:
    top, bottom = figure.subplots(2, 1, sharex=True)
    mean, sem = curve(results, 'manipulability')
    _draw_band(top, results, mean, sem, AGENT)
    _draw_band(bottom, results, 1 - mean ** 2, 2 * mean * sem, AGENT)
    top.set_ylabel(r'$k_w=\sqrt{\det(J J^T)}$')
    bottom.set(ylabel='$1-k_w^2$', xlabel='Time (s)')
    _legend(figure)


def _legend(figure: SubFigure) -> None:
    """One for all plots of a figure, as they have the same."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc='outside lower center', ncols=3)


def _draw_curve(axes: Axes, results: Sequence[ProtocolResult], track: str, absolute: bool, colour: str = AGENT) -> None:
    label, scale = _LABELS[track]
    mean, sem = curve(results, track, absolute)
    _draw_band(axes, results, scale * mean, scale * sem, colour)
    axes.axhline(0, color=FAINT, linewidth=0.8)
    axes.set_ylabel(f'|{label.replace(" (", "| (", 1)}' if absolute else label)


def _draw_band(axes: Axes, results: Sequence[ProtocolResult], mean: np.ndarray, sem: np.ndarray, colour: str) -> None:
    seconds = results[0].seconds
    over = 'policies' if len(results) > 1 else 'episodes'
    count = _averaged(results)
    axes.plot(seconds, mean, color=colour, label=f'mean over {count} {over}' if count > 1 else 'one episode')
    if count >= ENOUGH and np.isfinite(sem).any():  # of fewer it would look certain
        axes.fill_between(seconds, mean - sem, mean + sem, color=colour, alpha=0.25, linewidth=0,
                          label='± standard error')
    if results[0].test == 'perturbation':
        for (start, end), label in zip(PUSHES, ('push', None), strict=True):
            axes.axvspan(start, end, color=GOOD, alpha=0.15, linewidth=0, label=label)
    axes.set_xlim(0, seconds[-1])
