"""Figs. 3-11 of the thesis, and what belongs beside them."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import accumulate

import numpy as np
from matplotlib.figure import Figure
from shared_control.control.references import FREQUENCIES, cosine_velocity
from shared_control.robot.spec_file import panda

from ..plotting.plot import Plot
from ..plotting.style import AGENT, BAD, FAINT, GOOD, HUMAN
from .chain import full_chain, table_2_chain
from .tracking import GAIN_SETS, SECONDS, SETTLING_SECONDS, Tracking

SCENARIOS = {True: 'Scenario 1: with the non-linear terms', False: 'Scenario 2: without'}
COLOURS = {True: AGENT, False: HUMAN}
_EVERY = 10
"""Every so many of the samples at 1 kHz are drawn."""


def plots(runs: Sequence[Tracking]) -> Iterator[Plot]:
    """All of them."""
    for number, frequency in enumerate(FREQUENCIES, start=3):
        yield Plot(f'fig{number:02d}_reference_{_slug(frequency)}', partial(_draw_reference, frequency), (8, 3.4))
    for first, gains in zip((6, 9), GAIN_SETS, strict=True):
        for number, frequency in enumerate(FREQUENCIES, start=first):
            pair = [run for run in runs if run.gains == gains and run.frequency == frequency]
            yield Plot(f'fig{number:02d}_tracking_{gains}_gains_{_slug(frequency)}', partial(_draw_tracking, pair),
                       (8, 6))
    yield Plot('rms_errors', partial(_draw_rms, runs), (9, 4))
    yield Plot('distance_from_reference', partial(_draw_distances, runs), (9, 4.4))
    yield Plot('manipulability', partial(_draw_manipulability, runs), (8, 5))
    yield Plot('chain_of_table_2', _draw_chains, (6, 6))


def _slug(frequency: float) -> str:
    return f'{frequency:.2f}hz'


def _draw_reference(frequency: float, figure: Figure) -> None:
    axes = figure.subplots()
    seconds = np.linspace(0, SECONDS, 1000)
    axes.plot(seconds, cosine_velocity(seconds, frequency), color=GOOD)
    axes.set(title=f"Reference of the tray's velocity along x, {frequency:g} Hz", xlabel='Time (s)',
             ylabel='Velocity (m/s)', ylim=(-0.34, 0.34), xlim=(0, SECONDS))


def _draw_tracking(pair: Sequence[Tracking], figure: Figure) -> None:
    figure.suptitle(f'Velocity along x with the {pair[0].gains} gains of Table 3, {pair[0].frequency:g} Hz', x=0.01,
                    ha='left', fontsize=13, fontweight='bold')
    plots = figure.subplots(2, 1, sharex=True, sharey=True)
    for axes, run in zip(plots, pair, strict=True):
        axes.plot(run.seconds[::_EVERY], run.measured[::_EVERY], color=COLOURS[run.nonlinear_terms], label='measured')
        axes.plot(run.seconds[::_EVERY], run.reference[::_EVERY], '--', color=GOOD, linewidth=1.3, label='reference')
        axes.set_title(f'{SCENARIOS[run.nonlinear_terms]}; RMS error {1e3 * run.rms:.1f} mm/s, '
                       f'{1e3 * run.rms_settled:.2f} after {SETTLING_SECONDS:g} s', fontsize=10.5)
        axes.set_ylabel('Velocity (m/s)')
    plots[0].legend(loc='upper right', ncols=2)
    plots[1].set(xlabel='Time (s)', xlim=(0, SECONDS))


def _draw_rms(runs: Sequence[Tracking], figure: Figure) -> None:
    figure.suptitle(f'RMS error of the velocity; dark: without the first {SETTLING_SECONDS:g} s', x=0.01, ha='left',
                    fontsize=13, fontweight='bold')
    places = np.arange(len(FREQUENCIES))
    for axes, gains in zip(figure.subplots(1, 2, sharey=True), GAIN_SETS, strict=True):
        for with_terms, shift in ((True, -0.2), (False, 0.2)):
            chosen = [run for run in runs if run.gains == gains and run.nonlinear_terms == with_terms]
            axes.bar(places + shift, [1e3 * run.rms for run in chosen], 0.36, color=COLOURS[with_terms], alpha=0.35)
            axes.bar(places + shift, [1e3 * run.rms_settled for run in chosen], 0.36, color=COLOURS[with_terms],
                     label=SCENARIOS[with_terms])
        axes.set_xticks(places, [f'{frequency:g} Hz' for frequency in FREQUENCIES])
        axes.set_title(f'{gains} gains')
        axes.grid(visible=False, axis='x')
    figure.axes[0].set_ylabel('RMS error (mm/s)')
    figure.axes[0].legend(loc='upper left')


def _draw_distances(runs: Sequence[Tracking], figure: Figure) -> None:
    figure.suptitle('Distance of the tray from its reference', x=0.01, ha='left', fontsize=13, fontweight='bold')
    for axes, gains in zip(figure.subplots(1, 2, sharey=True), GAIN_SETS, strict=True):
        for run in runs:
            if run.gains == gains:
                width = 1.0 + FREQUENCIES.index(run.frequency)
                axes.plot(run.seconds[::_EVERY], 1e3 * run.distance[::_EVERY], color=COLOURS[run.nonlinear_terms],
                          linewidth=width, alpha=0.5)
        axes.set(title=f'{gains} gains', xlabel='Time (s)', yscale='log')
    for scenario, label in SCENARIOS.items():
        figure.axes[0].plot([], [], color=COLOURS[scenario], label=label)
    figure.axes[0].plot([], [], color=FAINT, alpha=0, label='thin to thick: 0.25, 0.5, 1 Hz')
    figure.axes[0].set_ylabel('Distance (mm)')
    figure.legend(loc='outside lower center', ncols=3)


def _draw_manipulability(runs: Sequence[Tracking], figure: Figure) -> None:
    figure.suptitle('Manipulability on the way (high gains, with the non-linear terms)', x=0.01, ha='left', fontsize=13,
                    fontweight='bold')
    top, bottom = figure.subplots(2, 1, sharex=True)
    for run in runs:
        if run.gains == 'high' and run.nonlinear_terms:
            k_w, shade = run.manipulability[::_EVERY], 0.4 + 0.3 * FREQUENCIES.index(run.frequency)
            for axes, values in ((top, k_w), (bottom, 1 - k_w ** 2)):
                axes.plot(run.seconds[::_EVERY], values, color=AGENT, alpha=shade, label=f'{run.frequency:g} Hz')
    top.set_ylabel(r'$k_w=\sqrt{\det(J J^T)}$ (34)')
    bottom.set(ylabel='$1-k_w^2$ (appendix)', xlabel='Time (s)', xlim=(0, SECONDS))
    top.legend(loc='upper right', ncols=3)


def _draw_chains(figure: Figure) -> None:
    axes = figure.subplots()
    for chain, colour, label in ((full_chain, AGENT, 'Panda'), (table_2_chain, BAD, 'Table 2, same joint positions')):
        frames = accumulate(chain(panda().home), np.matmul, initial=np.eye(4))
        points = np.array([frame[:3, 3] for frame in frames])
        axes.plot(points[:, 0], points[:, 2], 'o-', color=colour, linewidth=3, markersize=6, label=label)
        x, z = points[-1, 0], points[-1, 2]
        axes.annotate(f'({x:.3f}, {z:.3f})', (x, z), xytext=(8, 8), textcoords='offset points', color=colour)
    axes.set(title='The reference posture from the side', xlabel='x (m)', ylabel='z (m)', aspect='equal')
    axes.margins(0.3, 0.12)
    axes.legend(loc='lower left', bbox_to_anchor=(0.2, 0.8))
