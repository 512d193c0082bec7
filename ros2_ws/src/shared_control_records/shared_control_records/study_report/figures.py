"""Figs. 14 to 24 of the thesis from a study's runs: each a plot, and the numbers that it draws."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from shared_control.control.references import FREQUENCIES
from shared_control_learning.evaluation.perturbation import PUSHES
from shared_control_learning.evaluation.result import ProtocolResult

from ..plotting.style import AGENT, FAINT, HUMAN, INK, say_empty
from ..study.plan import PERSON
from ..study.result import RunResult
from .measures import BEST, TRAY_END, Study, times
from .statistics import survival

COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9')
"""Colours of conditions, in the plan's order (Okabe and Ito)."""
RETURN_SHOWN = (-1500.0, 750.0)
"""Returns below are drawn at the edge: an episode in which the ball falls costs 5000."""
LOW_HIGH_SHARE = 3
"""The best and the worst third of real participants count as high and low performers."""

Draw = Callable[[Figure, Study], pd.DataFrame]


@dataclass(frozen=True)
class Plot:
    """A figure of the report."""

    name: str
    """Name of its files."""
    title: str
    thesis: str
    """What the thesis' own figure shows."""
    draw: Draw
    """Draws it, and gives the numbers."""


def new_figure() -> Figure:
    """An empty figure of the report's size."""
    figure = Figure(figsize=(10.5, 4.0), layout='constrained')
    FigureCanvasAgg(figure)
    return figure


def colour_of(study: Study, condition: str) -> str:
    """The colour of a condition."""
    return COLOURS[[c.name for c in study.plan.conditions].index(condition) % len(COLOURS)]


def draw_returns(figure: Figure, study: Study) -> pd.DataFrame:
    """Fig. 14: return by episode, every run, the best of each condition in bold."""
    axes = figure.subplots()
    axes.set(xlabel='Episode of training', ylabel='Return', ylim=RETURN_SHOWN)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    rows = []
    for condition in study.conditions:
        colour = colour_of(study, condition)
        best = study.best(condition, 1)[0]
        for run in study.of(condition):
            numbers = [row['episode'] for row in run.episodes]
            returns = np.array([row['return'] for row in run.episodes])
            is_best = run is best
            axes.plot(numbers, np.clip(returns, *RETURN_SHOWN), color=colour, alpha=1.0 if is_best else 0.13,
                      linewidth=2.2 if is_best else 1.0, zorder=3 if is_best else 2, marker='o' if is_best else '',
                      markersize=3.5, label=f'{condition}, best (participant {run.participant})' if is_best else None)
            rows += [{'condition': condition, 'participant': run.participant, 'episode': number, 'return': value}
                     for number, value in zip(numbers, returns, strict=True)]
    figure.legend(loc='outside right upper')  # wherever it lay within, a curve would run below it
    return pd.DataFrame(rows)


def draw_episodes(figure: Figure, study: Study) -> pd.DataFrame:
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
    longest = max(row['episodes'] for row in rows)
    dots.set(title='Episodes to skilled; bar: median', ylabel='Episodes', ylim=(0, 1.25 * longest),  # room for a legend
             xlim=(-0.5, len(study.conditions) - 0.5))
    dots.set_xticks(range(len(study.conditions)), study.conditions)
    dots.plot([], [], '^', color=FAINT, markerfacecolor='none', label='not skilled when training ended')
    dots.legend(loc='upper left')
    curves.set(title='Not yet skilled (Kaplan-Meier, 95 %)', xlabel='Episodes', ylabel='Share of runs (%)',
               ylim=(0, 103))
    curves.legend(loc='best')
    return pd.DataFrame(rows)


def draw_test(test: str, track: str) -> Draw:
    """Figs. 16 to 19: mean of a track over the policies of each condition, +- SEM; the best five, and all."""
    def draw(figure: Figure, study: Study) -> pd.DataFrame:
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
                policies = 100 * np.array([_mean_track(result, track) for result in tested])
                mean, sem = _mean_and_sem(policies)
                _line(axes, tested[0].seconds, mean, sem, colour_of(study, condition),
                      f'{condition} (n = {len(tested)})')
                rows.append(pd.DataFrame({
                    'policies': title, 'condition': condition, 'seconds': tested[0].seconds, 'mean': mean, 'sem': sem,
                    'n': len(tested)}))
            _legend(axes, 'no policy went through this test')
        of_panels[0].set_ylabel(_label(track))
        return pd.concat(rows) if rows else pd.DataFrame()

    return draw


def draw_actions(first: str, second: str) -> Draw:
    """Figs. 20 and 21: mean |moment| of human and agent by episode of training, for two groups of participants."""
    def draw(figure: Figure, study: Study) -> pd.DataFrame:
        panels = figure.subplots(1, 2, sharey=True)
        condition = next((c.name for c in study.plan.conditions if c.taught and study.of(c.name)), None)
        rows = []
        for axes in panels:
            axes.tick_params(labelleft=True)  # one of the two may be empty
        for axes, group in zip(panels, (first, second), strict=True):
            runs = _group(study, condition, group) if condition else []
            axes.set(title=f'{group.capitalize()} performers (n = {len(runs)})', xlabel='Episode of training')
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
            for who, colour in (('human', HUMAN), ('agent', AGENT)) if runs else ():
                numbers, mean, sem, count = _by_episode(runs, f'mean_abs_{who}')
                _line(axes, numbers, mean, sem, colour, who)
                rows.append(pd.DataFrame({'group': group, 'who': who, 'condition': condition, 'episode': numbers,
                                          'mean': mean, 'sem': sem, 'n': count}))
            _legend(axes, 'no such participants in this study')
        panels[0].set_ylabel('Mean |moment| in an episode (N m)')
        return pd.concat(rows) if rows else pd.DataFrame()

    return draw


def draw_trajectory(frequency: float) -> Draw:
    """Figs. 22 to 24: position and velocity error on a moving tray; the best policy of each condition."""
    name = f'trajectory {frequency:g} Hz'

    def draw(figure: Figure, study: Study) -> pd.DataFrame:
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


def _mean_track(result: ProtocolResult, track: str) -> np.ndarray:
    """Mean over the episodes of a policy; (steps,). A ball that fell stays at the tray's end, at rest."""
    if track != 'position_error':
        return np.nan_to_num(getattr(result, track), nan=0.0).mean(axis=0)
    last = np.sign([row[np.isfinite(row)][-1:].sum() for row in result.position_error])
    return np.where(np.isnan(result.position_error), TRAY_END * last[:, None], result.position_error).mean(axis=0)


def _mean_and_sem(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard error of the mean over the rows; no error of a single one."""
    count = len(values)
    sem = values.std(axis=0, ddof=1) / np.sqrt(count) if count > 1 else np.zeros(values.shape[1])
    return values.mean(axis=0), sem


def _by_episode(runs: list[RunResult], column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Numbers of episodes; mean and SEM over the runs that had such an episode, and how many those were."""
    values = [np.array([row[column] for row in run.episodes]) for run in runs]
    length = max(map(len, values))
    table = np.full((len(values), length), np.nan)
    for row, own in zip(table, values, strict=True):
        row[:len(own)] = own
    count = np.isfinite(table).sum(axis=0)
    mean = np.nanmean(table, axis=0)
    spread = np.sqrt(np.nansum((table - mean) ** 2, axis=0) / np.maximum(count - 1, 1))
    return np.arange(1, length + 1), mean, np.where(count > 1, spread / np.sqrt(count), 0.0), count


def _group(study: Study, condition: str, group: str) -> list[RunResult]:
    """Runs of a kind of participants: by the profile of simulated ones, by how well real ones did."""
    runs = study.of(condition)
    if any(run.group != PERSON for run in runs):
        return [run for run in runs if run.group == group]
    ranked = study.best(condition, None)
    third = len(ranked) // LOW_HIGH_SHARE
    return {'high': ranked[:third], 'low': ranked[len(ranked) - third:]}.get(group, [])


def _line(axes: Axes, x: np.ndarray, mean: np.ndarray, sem: np.ndarray, colour: str, label: str) -> None:
    axes.plot(x, mean, color=colour, label=label)
    axes.fill_between(x, mean - sem, mean + sem, color=colour, alpha=0.2, linewidth=0)


def _mark_pushes(axes: Axes, test: str) -> None:
    for start, end in PUSHES if test == 'perturbation' else ():
        axes.axvspan(start, end, color=FAINT, alpha=0.2, linewidth=0)


def _legend(axes: Axes, otherwise: str) -> None:
    if axes.lines:
        axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1)
        axes.legend(loc='upper right')
    else:
        say_empty(axes, otherwise)


def _label(track: str) -> str:
    return {'position_error': 'Ball position error (cm)', 'velocity_error': 'Ball velocity error (cm/s)'}[track]


def plots() -> Iterator[Plot]:
    """All figures, in the thesis' order."""
    yield Plot('fig14_return', 'Fig. 14: return during training',
               'Best of each: skilled after 45 episodes with a human, after about 600 alone.', draw_returns)
    yield Plot('fig15_episodes', 'Fig. 15: episodes in which training is complete',
               'Mean of the best five: 17 episodes with a human, 788 alone.', draw_episodes)
    for number, test, track, said in (
            (16, 'randomized', 'position_error', 'With a human near zero; alone the ball oscillates about the centre.'),
            (17, 'randomized', 'velocity_error', 'With a human the ball is kept at rest; alone it is not.'),
            (18, 'perturbation', 'position_error', 'Both regulate; alone varies more, above all while pushed.'),
            (19, 'perturbation', 'velocity_error', 'Spikes at the pushes alone; slowed down with a human.')):
        yield Plot(f'fig{number}_{test}_{track.removesuffix("_error")}', f'Fig. {number}: {_TITLES[test, track]}', said,
                   draw_test(test, track))
    yield Plot('fig20_low_high', 'Fig. 20: moments of human and agent, low and high performers',
               'Both begin with little, and do more after 25 episodes; the high performer varies less and hands over '
               'after 35 episodes, the low one after 45.', draw_actions('low', 'high'))
    yield Plot('fig21_expert_high', 'Fig. 21: moments of human and agent, expert and high performers',
               'The expert acts from the first episode on; the robot is autonomous after the 9th.',
               draw_actions('expert', 'high'))
    for number, frequency in zip((22, 23, 24), FREQUENCIES, strict=True):
        yield Plot(f'fig{number}_trajectory', f'Fig. {number}: on a tray that moves at {frequency:g} Hz',
                   'The best policy taught by a human keeps both errors close to zero.', draw_trajectory(frequency))


_TITLES = {('randomized', 'position_error'): 'position error in the randomised test',
           ('randomized', 'velocity_error'): 'velocity error in the randomised test',
           ('perturbation', 'position_error'): 'position error in the perturbation test (grey: 50 N pushes)',
           ('perturbation', 'velocity_error'): 'velocity error in the perturbation test (grey: 50 N pushes)'}


def draw_all(study: Study) -> Iterable[tuple[Plot, Figure, pd.DataFrame]]:
    """Every figure with its numbers."""
    for plot in plots():
        figure = new_figure()
        yield plot, figure, plot.draw(figure, study)
