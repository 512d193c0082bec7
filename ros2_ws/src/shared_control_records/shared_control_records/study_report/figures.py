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

"""Figs. 14 to 24 of the thesis from a study's runs: each a plot, and the numbers that it draws."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from matplotlib.ticker import MaxNLocator
from shared_control.control.references import FREQUENCIES
from shared_control_learning.evaluation.perturbation import PUSHES
from shared_control_learning.evaluation.result import ProtocolResult
from shared_control_learning.evaluation.statistics import mean_and_sem

from ..plotting.plot import Sheet
from ..plotting.style import AGENT, FAINT, HUMAN, INK, say_empty
from ..study.plan import PERSON
from ..study.result import RunResult
from .measures import BEST, Study, times
from .statistics import ENOUGH, survival

COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9')
"""Colours of conditions, in the plan's order (Okabe and Ito)."""
LOW_HIGH_SHARE = 3
"""The best and the worst third of real participants count as high and low performers."""

Draw = Callable[[SubFigure, Study], pd.DataFrame]


@dataclass(frozen=True)
class StudyPlot:
    """A figure of the report."""

    name: str
    """Name of its files."""
    title: str
    caption: str
    """What is drawn, with units."""
    thesis: str
    """What the thesis' own figure shows."""
    draw: Draw
    """Draws it, and gives the numbers."""


def colour_of(study: Study, condition: str) -> str:
    """The colour of a condition."""
    return COLOURS[[c.name for c in study.plan.conditions].index(condition) % len(COLOURS)]


def draw_returns(figure: SubFigure, study: Study) -> pd.DataFrame:
    """Fig. 14: return by episode, every run, the best of each condition in bold."""
    axes = figure.subplots()
    low, high = _returns_shown(study)
    axes.set(xlabel='Episode of training', ylabel='Return (sum of rewards)', ylim=(low, high))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    rows = []
    for condition in study.conditions:
        colour = colour_of(study, condition)
        best = study.best(condition, 1)[0]
        for run in study.of(condition):
            numbers = [row['episode'] for row in run.episodes]
            returns = np.array([row['return'] for row in run.episodes])
            is_best = run is best
            axes.plot(numbers, np.clip(returns, low, high), color=colour, alpha=1.0 if is_best else 0.13,
                      linewidth=2.2 if is_best else 1.0, zorder=3 if is_best else 2, marker='o' if is_best else '',
                      markersize=3.5, label=f'{condition}, best (participant {run.participant})' if is_best else None)
            rows += [{'condition': condition, 'participant': run.participant, 'episode': number, 'return': value}
                     for number, value in zip(numbers, returns, strict=True)]
    figure.legend(loc='outside lower center', ncols=3)  # wherever it lay within, a curve would run below it
    return pd.DataFrame(rows)


def draw_episodes(figure: SubFigure, study: Study) -> pd.DataFrame:
    """Fig. 15: episodes to skilled, every run and the median; and how many are still waiting."""
    dots, curves = figure.subplots(1, 2)
    rows = []
    random = np.random.default_rng(0)
    for index, condition in enumerate(study.conditions):
        colour = colour_of(study, condition)
        reached = times(study.of(condition))
        where = index + random.uniform(-0.18, 0.18, len(reached.episodes))
        for marker, chosen, face in (('o', reached.reached, colour), ('^', ~reached.reached, 'none')):
            dots.plot(where[chosen], reached.episodes[chosen], marker, color=colour, markerfacecolor=face, alpha=0.7)
        curve = survival(reached)
        if np.isfinite(curve.median.value):
            dots.plot([index - 0.32, index + 0.32], [curve.median.value] * 2, color=INK, linewidth=2.5)
            dots.annotate(f'{curve.median.value:g}', (index + 0.34, curve.median.value), va='center', fontweight='bold')
        curves.step(curve.episodes, 100 * curve.waiting, where='post', color=colour, label=condition)
        curves.fill_between(curve.episodes, 100 * curve.low, 100 * curve.high, step='post', color=colour, alpha=0.15,
                            linewidth=0)
        rows += [{'condition': condition, 'participant': run.participant, 'episodes': episodes, 'skilled': skilled}
                 for run, episodes, skilled in zip(study.of(condition), reached.episodes, reached.reached, strict=True)]
    longest = max(1, *(row['episodes'] for row in rows))
    dots.set(title='Episodes to skilled', ylabel='Episodes', ylim=(0, 1.25 * longest),  # room for a legend
             xlim=(-0.5, len(study.conditions) - 0.5))
    dots.set_xticks(range(len(study.conditions)), study.conditions)
    dots.plot([], [], 'o', color=FAINT, label='skilled')
    dots.plot([], [], '^', color=FAINT, markerfacecolor='none', label='not skilled when training ended')
    dots.plot([], [], color=INK, linewidth=2.5, label='median')
    dots.legend(loc='upper left')
    curves.set(title='Not yet skilled', xlabel='Episodes', ylabel='Share of runs (%)',
               ylim=(0, 103))
    curves.legend(loc='best')
    return pd.DataFrame(rows)


def draw_test(test: str, track: str) -> Draw:
    """Figs. 16 to 19: mean of a track over the policies of each condition, +- SEM; the best five, and all."""
    def draw(figure: SubFigure, study: Study) -> pd.DataFrame:
        panels = [(BEST, f'Best {BEST} of each condition'), (None, 'All')]
        if all(len(study.of(condition)) <= BEST for condition in study.conditions):
            panels = panels[1:]  # the best five are all
        rows = []
        of_panels = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axes, (count, title) in zip(of_panels, panels, strict=True):
            axes.set(title=title, xlabel='Time in the episode (s)')
            _mark_pushes(axes, test)
            for condition in study.conditions:
                runs = study.of(condition) if count is None else study.best(condition, count)
                tested = [run.tests[test] for run in runs if test in run.tests]
                if not tested:
                    continue
                lost = study.lost(runs[0])
                policies = 100 * np.array([_mean_track(result, track, lost) for result in tested])
                mean, sem = mean_and_sem(policies)
                _line(axes, tested[0].seconds, mean, _if_enough(sem, len(tested)), colour_of(study, condition),
                      f'{condition} (n = {len(tested)})')
                rows.append(pd.DataFrame({
                    'policies': title, 'condition': condition, 'seconds': tested[0].seconds, 'mean': mean, 'sem': sem,
                    'n': len(tested)}))
            _legend(axes, 'no policy went through this test')
        of_panels[0].set_ylabel(_label(track))
        return pd.concat(rows) if rows else pd.DataFrame()

    return draw


def draw_actions(first: str, second: str) -> Draw:
    """Figs. 20 and 21: mean |moment| of human and robot by episode of training, for two groups of participants."""
    def draw(figure: SubFigure, study: Study) -> pd.DataFrame:
        panels = figure.subplots(1, 2, sharey=True)
        condition = next((c.name for c in study.plan.conditions if c.taught and study.of(c.name)), None)
        rows = []
        for axes in panels:
            axes.tick_params(labelleft=True)  # one of the two may be empty
        for axes, group in zip(panels, (first, second), strict=True):
            runs = _group(study, condition, group) if condition else []
            taught = f'{condition}, ' if condition else ''
            axes.set(title=f'{group.capitalize()} performers ({taught}n = {len(runs)})', xlabel='Episode of training')
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
            for who, column, colour in (('human', 'human', HUMAN), ('robot', 'agent', AGENT)) if runs else ():
                numbers, mean, sem, count = _by_episode(runs, f'mean_abs_{column}')
                _line(axes, numbers, mean, _if_enough(sem, count), colour, f'{who}, mean')
                rows.append(pd.DataFrame({'group': group, 'who': who, 'condition': condition, 'episode': numbers,
                                          'mean': mean, 'sem': sem, 'n': count}))
            _legend(axes, 'no such participants in this study')
        panels[0].set_ylabel('Mean |moment| in an episode (N m)')
        return pd.concat(rows) if rows else pd.DataFrame()

    return draw


def draw_trajectory(frequency: float) -> Draw:
    """Figs. 22 to 24: position and velocity error on a moving tray; the best policy of each condition."""
    name = f'trajectory {frequency:g} Hz'

    def draw(figure: SubFigure, study: Study) -> pd.DataFrame:
        rows = []
        panels = figure.subplots(1, 2)
        for axes, track in zip(panels, ('position_error', 'velocity_error'), strict=True):
            axes.set(xlabel='Time in the episode (s)', ylabel=_label(track))
            for condition in study.conditions:
                run = next((run for run in study.best(condition, None) if name in run.tests), None)
                if run is None:
                    continue
                result = run.tests[name]
                values = 100 * getattr(result, track)[0]
                axes.plot(result.seconds, values, color=colour_of(study, condition), linewidth=1.4,
                          label=f'{condition}, participant {run.participant}')
                rows.append(pd.DataFrame({'track': track, 'condition': condition, 'participant': run.participant,
                                          'seconds': result.seconds, 'value': values}))
            _legend(axes, 'no policy went through this test')
        return pd.concat(rows) if rows else pd.DataFrame()

    return draw


def _returns_shown(study: Study) -> tuple[float, float]:
    """From the least to the greatest return of an episode in which the ball is kept, and a little more.

    One in which it falls costs thousands: it is drawn at the edge.
    """
    rows = [row for run in study.runs for row in run.episodes]
    kept = [row['return'] for row in rows if not row['fallen']] or [row['return'] for row in rows] or [0.0]
    margin = 0.05 * (max(kept) - min(kept) or 1.0)
    return min(kept) - margin, max(kept) + margin


def _mean_track(result: ProtocolResult, track: str, lost: float) -> np.ndarray:
    """Mean over the episodes of a policy; (steps,). A ball that fell stays at rest ``lost`` m off."""
    if track != 'position_error':
        return np.nan_to_num(getattr(result, track), nan=0.0).mean(axis=0)
    last = np.sign([row[np.isfinite(row)][-1:].sum() for row in result.position_error])
    return np.where(np.isnan(result.position_error), lost * last[:, None], result.position_error).mean(axis=0)


def _by_episode(runs: list[RunResult], column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Numbers of episodes; mean and SEM over the runs that had such an episode, and how many those were."""
    values = [np.array([row[column] for row in run.episodes]) for run in runs]
    length = max(map(len, values))
    table = np.full((len(values), length), np.nan)
    for row, own in zip(table, values, strict=True):
        row[:len(own)] = own
    return np.arange(1, length + 1), *mean_and_sem(table), np.isfinite(table).sum(axis=0)


def _group(study: Study, condition: str, group: str) -> list[RunResult]:
    """Runs of a kind of participants: by the profile of simulated ones, by how well real ones did."""
    runs = study.of(condition)
    if any(run.group != PERSON for run in runs):
        return [run for run in runs if run.group == group]
    ranked = study.best(condition, None)
    third = len(ranked) // LOW_HIGH_SHARE
    return {'high': ranked[:third], 'low': ranked[len(ranked) - third:]}.get(group, [])


def _if_enough(sem: np.ndarray, count: int | np.ndarray) -> np.ndarray:
    """A standard error where there are enough to tell it from: a band of one or two looks certain."""
    return np.where(np.asarray(count) >= ENOUGH, sem, np.nan)


def _line(axes: Axes, x: np.ndarray, mean: np.ndarray, sem: np.ndarray, colour: str, label: str) -> None:
    axes.plot(x, mean, color=colour, label=label)
    if np.isfinite(sem).any():
        axes.fill_between(x, mean - sem, mean + sem, color=colour, alpha=0.2, linewidth=0)


def _mark_pushes(axes: Axes, test: str) -> None:
    for start, end in PUSHES if test == 'perturbation' else ():
        axes.axvspan(start, end, color=FAINT, alpha=0.2, linewidth=0,
                     label='50 N push' if start == PUSHES[0][0] else None)


def _legend(axes: Axes, otherwise: str) -> None:
    if axes.lines:
        axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1)
        axes.legend(loc='upper right')
    else:
        say_empty(axes, otherwise)


def _label(track: str) -> str:
    return {'position_error': 'Ball position error (cm)', 'velocity_error': 'Ball velocity error (cm/s)'}[track]


_RETURNS = ('Return (sum of rewards, no unit) by episode of every run; bold: the best run of each condition. Episodes '
            'in which the ball fell lie at the lower edge.')
_EPISODES = ('Left: episodes to skilled of every run, and the median of Kaplan and Meier. Right: share of the runs '
             f'that are not skilled yet (%), with its 95 % interval where a condition has at least {ENOUGH} runs.')
_TESTS = ('Mean over the n policies of a condition; band: plus and minus its standard error, where n is at least '
          f'{ENOUGH}. A ball that has fallen counts as lying where the tray ends.')
_MOMENTS = ('Mean |moment| of human and robot in an episode (N m), over the runs that had such an episode; band: plus '
            f'and minus its standard error, where they are at least {ENOUGH}.')
_TRAJECTORY = 'Position error (cm) and velocity error (cm/s) of the best policy of each condition, one episode each.'


def plots() -> Iterator[StudyPlot]:
    """All figures, in the thesis' order."""
    yield StudyPlot('fig14_return', 'Fig. 14: return during training', _RETURNS,
                    'Best of each: skilled after 45 episodes with a human, after about 600 alone.', draw_returns)
    yield StudyPlot('fig15_episodes', 'Fig. 15: episodes in which training is complete', _EPISODES,
                    'Mean of the best five: 17 episodes with a human, 788 alone.', draw_episodes)
    for number, test, track, said in (
            (16, 'randomized', 'position_error', 'With a human near zero; alone the ball oscillates about the centre.'),
            (17, 'randomized', 'velocity_error', 'With a human the ball is kept at rest; alone it is not.'),
            (18, 'perturbation', 'position_error', 'Both regulate; alone varies more, above all while pushed.'),
            (19, 'perturbation', 'velocity_error', 'Spikes at the pushes alone; slowed down with a human.')):
        yield StudyPlot(f'fig{number}_{test}_{track.removesuffix("_error")}', f'Fig. {number}: {_TITLES[test, track]}',
                        _TESTS, said, draw_test(test, track))
    yield StudyPlot('fig20_low_high', 'Fig. 20: moments of human and robot, low and high performers', _MOMENTS,
                    'Both begin with little, and do more after 25 episodes; the high performer varies less and hands '
                    'over after 35 episodes, the low one after 45.', draw_actions('low', 'high'))
    yield StudyPlot('fig21_expert_high', 'Fig. 21: moments of human and robot, expert and high performers', _MOMENTS,
                    'The expert acts from the first episode on; the robot is autonomous after the 9th.',
                    draw_actions('expert', 'high'))
    for number, frequency in zip((22, 23, 24), FREQUENCIES, strict=True):
        yield StudyPlot(f'fig{number}_trajectory', f'Fig. {number}: on a tray that moves at {frequency:g} Hz',
                        _TRAJECTORY, 'The best policy taught by a human keeps both errors close to zero.',
                        draw_trajectory(frequency))


_TITLES = {('randomized', 'position_error'): 'position error in the randomised test',
           ('randomized', 'velocity_error'): 'velocity error in the randomised test',
           ('perturbation', 'position_error'): 'position error in the perturbation test',
           ('perturbation', 'velocity_error'): 'velocity error in the perturbation test'}


def draw_all(study: Study) -> Iterable[tuple[StudyPlot, Sheet, pd.DataFrame]]:
    """Every figure with its numbers."""
    for plot in plots():
        sheet = Sheet(7.1, 3.0)
        yield plot, sheet, plot.draw(sheet.content, study)
