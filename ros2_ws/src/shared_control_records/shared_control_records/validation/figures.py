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

"""Figs. 3-11 of the thesis, and what belongs beside them."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import accumulate

import numpy as np
from matplotlib.figure import SubFigure
from shared_control.control.references import FREQUENCIES, cosine_velocity
from shared_control.robot.spec_file import panda

from ..plotting.plot import Plot
from ..plotting.style import AGENT, BAD, FAINT, GOOD, HUMAN
from .chain import full_chain, table_2_chain
from .tracking import GAIN_SETS, SECONDS, SETTLING_SECONDS, Tracking

SCENARIOS = {True: 'with the non-linear terms', False: 'without'}
COLOURS = {True: AGENT, False: HUMAN}
STYLES = {0.25: '-', 0.5: '--', 1.0: ':'}
"""Lines by frequency, Hz: told apart in print."""
_EVERY = 10
"""Every so many of the samples at 1 kHz are drawn."""
WHOLE, LOW = (7.1, 4.2), (7.1, 2.9)


def plots(runs: Sequence[Tracking]) -> Iterator[Plot]:
    """All of them."""
    for number, frequency in enumerate(FREQUENCIES, start=3):
        yield Plot(f'fig{number:02d}_reference_{_slug(frequency)}', partial(_draw_reference, frequency),
                   f"Reference of the tray's velocity along x, {frequency:g} Hz.", (7.1, 2.6))
    for first, gains in zip((6, 9), GAIN_SETS, strict=True):
        for number, frequency in enumerate(FREQUENCIES, start=first):
            pair = [run for run in runs if run.gains == gains and run.frequency == frequency]
            yield Plot(f'fig{number:02d}_tracking_{gains}_gains_{_slug(frequency)}', partial(_draw_tracking, pair),
                       f'Velocity of the tray along x, measured and asked for, with the {gains} gains of Table 3 at '
                       f'{frequency:g} Hz; one run each, with the non-linear terms (top) and without (bottom).', WHOLE)
    yield Plot('rms_errors', partial(_draw_rms, runs),
               'RMS error of the velocity of the tray by frequency of the reference: over the whole run (open) and '
               f'without its first {SETTLING_SECONDS:g} s (filled); one run each.', LOW)
    yield Plot('distance_from_reference', partial(_draw_distances, runs),
               'Distance of the tray from its reference over time, with high and low gains; one run each.', (7.1, 3.4))
    yield Plot('manipulability', partial(_draw_manipulability, runs),
               'Manipulability of Yoshikawa on the way, k_w (equation 34), and 1 - k_w^2 as the appendix of the thesis '
               'has it, both without unit; high gains, with the non-linear terms, one run each.', WHOLE)
    yield Plot('chain_of_table_2', _draw_chains,
               'The reference posture from the side: the joints of the Panda, and those that Table 2 of the thesis '
               'gives at the same joint positions; the numbers are x and z of the tray, m.', (4.4, 4.4))


def _slug(frequency: float) -> str:
    return f'{frequency:.2f}hz'


def _draw_reference(frequency: float, figure: SubFigure) -> None:
    axes = figure.subplots()
    seconds = np.linspace(0, SECONDS, 1000)
    axes.plot(seconds, cosine_velocity(seconds, frequency), color=GOOD, label=f'reference, {frequency:g} Hz')
    axes.set(xlabel='Time (s)', ylabel='Velocity along x (m/s)', ylim=(-0.34, 0.34), xlim=(0, SECONDS))
    figure.legend(loc='outside upper right')


def _draw_tracking(pair: Sequence[Tracking], figure: SubFigure) -> None:
    plots = figure.subplots(2, 1, sharex=True, sharey=True)
    for axes, run in zip(plots, pair, strict=True):
        # The reference lies below, wide and grey: drawn over it, it would hide what was measured.
        axes.plot(run.seconds[::_EVERY], run.reference[::_EVERY], color=FAINT, alpha=0.55, linewidth=3.5,
                  label='reference')
        axes.plot(run.seconds[::_EVERY], run.measured[::_EVERY], color=COLOURS[run.nonlinear_terms],
                  label=f'measured {SCENARIOS[run.nonlinear_terms]}')
        axes.set_title(f'{SCENARIOS[run.nonlinear_terms].capitalize()}: RMS error {1e3 * run.rms:.1f} mm/s, '
                       f'{1e3 * run.rms_settled:.2f} mm/s after {SETTLING_SECONDS:g} s')
        axes.set_ylabel('Velocity along x (m/s)')
    handles, labels = plots[0].get_legend_handles_labels()
    more, names = plots[1].get_legend_handles_labels()
    figure.legend([*handles, more[-1]], [*labels, names[-1]], loc='outside lower center', ncols=3)
    plots[1].set(xlabel='Time (s)', xlim=(0, SECONDS))


def _draw_rms(runs: Sequence[Tracking], figure: SubFigure) -> None:
    places = np.arange(len(FREQUENCIES))
    for axes, gains in zip(figure.subplots(1, 2, sharey=True), GAIN_SETS, strict=True):
        for with_terms, shift in ((True, -0.12), (False, 0.12)):
            chosen = [run for run in runs if run.gains == gains and run.nonlinear_terms == with_terms]
            for values, fill, when in (([1e3 * run.rms for run in chosen], 'none', 'whole run'),
                                       ([1e3 * run.rms_settled for run in chosen], 'full', 'settled')):
                axes.plot(places + shift, values, 's' if with_terms else 'o', color=COLOURS[with_terms], fillstyle=fill,
                          markersize=6, clip_on=False, label=f'{SCENARIOS[with_terms]}, {when}')
        axes.set_xticks(places, [f'{frequency:g} Hz' for frequency in FREQUENCIES])
        axes.set(title=f'{gains.capitalize()} gains', xlabel='Reference', xlim=(-0.5, len(places) - 0.5))
        axes.grid(visible=False, axis='x')
    figure.axes[0].set_ylabel('RMS error of the velocity (mm/s)')
    figure.axes[0].set_ylim(bottom=0, top=1.08e3 * max(run.rms for run in runs))
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc='outside lower center', ncols=2)


def _draw_distances(runs: Sequence[Tracking], figure: SubFigure) -> None:
    for axes, gains in zip(figure.subplots(1, 2, sharey=True), GAIN_SETS, strict=True):
        for run in runs:
            if run.gains == gains:
                axes.plot(run.seconds[::_EVERY], 1e3 * run.distance[::_EVERY], STYLES[run.frequency],
                          color=COLOURS[run.nonlinear_terms], linewidth=1.0,
                          label=f'{run.frequency:g} Hz, {SCENARIOS[run.nonlinear_terms]}')
        axes.set(title=f'{gains.capitalize()} gains', xlabel='Time (s)', yscale='log')
    figure.axes[0].set_ylabel('Distance (mm)')
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc='outside lower center', ncols=3)


def _draw_manipulability(runs: Sequence[Tracking], figure: SubFigure) -> None:
    top, bottom = figure.subplots(2, 1, sharex=True)
    for run in runs:
        if run.gains == 'high' and run.nonlinear_terms:
            k_w = run.manipulability[::_EVERY]
            for axes, values in ((top, k_w), (bottom, 1 - k_w ** 2)):
                axes.plot(run.seconds[::_EVERY], values, STYLES[run.frequency], color=AGENT,
                          label=f'{run.frequency:g} Hz')
    top.set_ylabel(r'$k_w=\sqrt{\det(J J^T)}$')
    bottom.set(ylabel='$1-k_w^2$', xlabel='Time (s)', xlim=(0, SECONDS))
    figure.legend(*top.get_legend_handles_labels(), loc='outside lower center', ncols=3)


def _draw_chains(figure: SubFigure) -> None:
    axes = figure.subplots()
    for chain, colour, label in ((full_chain, AGENT, 'Panda'), (table_2_chain, BAD, 'Table 2, same joint positions')):
        frames = accumulate(chain(panda().home), np.matmul, initial=np.eye(4))
        points = np.array([frame[:3, 3] for frame in frames])
        axes.plot(points[:, 0], points[:, 2], 'o-', color=colour, linewidth=3, markersize=6, label=label)
        x, z = points[-1, 0], points[-1, 2]
        axes.annotate(f'({x:.3f}, {z:.3f})', (x, z), xytext=(8, 8), textcoords='offset points', color=colour)
    axes.set(xlabel='x (m)', ylabel='z (m)', aspect='equal')
    axes.margins(0.3, 0.12)
    figure.legend(loc='outside lower center', ncols=2)
