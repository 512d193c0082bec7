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

"""One picture of what happened in a session (``picture.png``)."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_hex, to_rgb
from matplotlib.image import imsave
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict
from shared_control.wrench import AXIS_NAMES

from ..bag.ball_tracks import EpisodeTrack
from ..bag.reader import Bag
from ..bag.recorded import Wrenches
from ..bag.runs import run_window
from ..plotting.plot import Sheet
from ..plotting.style import AGENT, BAD, FAINT, GOOD, HUMAN, SEQUENCE, STYLE, cross, say_empty
from .episodes import EpisodeRow
from .final_test import FinalTest
from .from_above import draw_track, draw_tray

BEYOND = 1.25
"""Errors are drawn up to this many times the half length of the tray."""
DPI = 110
ENDS_SHOWN = 4
"""This many of the first and of the last stand out of many episodes."""
LONGEST_GAP = 600.0
"""Between two episodes, s; a longer one is no pause: the robot's time was set."""
GAP = 2.0
"""Drawn instead, s."""
MOMENT_BINS = 1500
"""Across the width of the picture."""


@dataclass(frozen=True)
class Panel:
    """A part of the picture, for a page that shows them one by one."""

    name: str
    caption: str
    """What is seen, with units."""
    png: bytes
    wide: bool = False
    """Whether it needs the whole width of a page."""


def draw_picture(path: Path, title: str, footer: str, bag: Bag | None, tracks: Sequence[EpisodeTrack],
                 rows: Sequence[EpisodeRow], test: FinalTest | None, task: Task) -> list[Panel]:
    """Draw what there is of a session; a plot without data says so. Gives the parts of the picture.

    Args:
        path: of the PNG; an SVG and a PDF are written beside it.
        title: who taught whom.
        footer: where it comes from (:func:`shared_control_records.plotting.plot.origin`).
        tracks: finished episodes; taught ones are drawn that nobody has discarded.
        rows: table of episodes, likewise.
        task: what was learned; with two axes tracks are drawn from above.
    """
    taught = [track for track in tracks if track.phase == 'teach' and track.verdict is not Verdict.DISCARD]
    rows = [row for row in rows if row.phase == 'teach' and row.counts]
    with matplotlib.rc_context(STYLE):
        sheet = Sheet(13, 11.5, w_pad=0.12, h_pad=0.12, hspace=0.04, wspace=0.03)
        figure = sheet.content
        figure.suptitle(title, x=0.01, ha='left', fontsize=15, fontweight='bold')
        grid = figure.add_gridspec(4, 6, height_ratios=(3.2, 1.15, 1.15, 2.2))
        lessons, alone = figure.add_subplot(grid[0, :3]), figure.add_subplot(grid[0, 3:])
        fallen = {row.number for row in rows if row.fallen}
        if len(task.axes) == 1:
            alone.sharey(lessons)
            _draw_lessons(lessons, task, taught, fallen)
            _draw_test_tracks(alone, task, test)
        else:
            _draw_lessons_from_above(lessons, task, taught, fallen)
            _draw_test_from_above(alone, task, test)
        human = figure.add_subplot(grid[1, :])
        agent = figure.add_subplot(grid[2, :], sharex=human, sharey=human)
        _draw_moments(human, agent, bag, taught)
        returns, shares, results = (figure.add_subplot(grid[3, index:index + 2]) for index in (0, 2, 4))
        _draw_returns(returns, rows)
        _draw_shares(shares, rows)
        _draw_test_results(results, test)
        pixels = sheet.save(path.with_suffix(''), footer, title, dpi=DPI)
        scale = [axes for axes in figure.axes if axes.get_label() == '<colorbar>']
        parts = (('lessons', [lessons, *scale], False), ('alone', [alone], False), ('moments', [human, agent], True),
                 ('returns', [returns], False), ('shares', [shares], False), ('results', [results], False))
        sheet.figure.set_canvas(FigureCanvasAgg(sheet.figure))  # by which the parts are measured
        captions = _captions(task, taught, rows, test)
        return [Panel(name, captions[name], _cut(sheet, pixels, axes), wide) for name, axes, wide in parts]


def _captions(task: Task, taught: Sequence[EpisodeTrack], rows: Sequence[EpisodeRow], test: FinalTest | None
              ) -> dict[str, str]:
    above = len(task.axes) > 1
    how = 'from above' if above else 'its position error over time (cm)'
    count = '1 episode' if len(taught) == 1 else f'{len(taught)} episodes'
    radius = f'{100 * task.scene.goal_radius:g} cm'
    tested = 'The robot was not tested alone.' if test is None else (
        f'The robot alone: the ball in {len(test.episodes)} tests, {how}; blue-green: a success, red: none, x: the '
        f'ball fell. {test.successes} of {len(test.episodes)} succeed.')
    return {
        'lessons': f'Taught: the ball in {count}, {how}; dark: late episodes, x: the ball fell.'
                   + (f' Green: within {radius} of the goal.' if not above else ' Green circle: the goal.'),
        'alone': tested,
        'moments': "Moments on the tray as the controller applied them (N m), over the robot's time in the episodes "
                   '(s). Pale: all values of a short span; line: mean of 0.5 s.',
        'returns': f'Return (sum of rewards, no unit) of {len(rows)} episodes; x: the ball fell.',
        'shares': 'Human share of the moment by episode (%): mean of |human| / (|human| + |robot|) over its steps.',
        'results': 'The robot alone: mean |position error| of the last 3 s (cm) over that at the start (cm); a '
                   f'success stays under {radius}, at rest. o: success, triangle: kept, x: the ball fell (at the '
                   'edge).'}


def _cut(sheet: Sheet, pixels: np.ndarray, parts: Sequence[Axes]) -> bytes:
    """A part of the picture, with its titles and labels, as a PNG; ``pixels`` is (height, width, 4)."""
    box = Bbox.union([box for axes in parts for box in [axes.get_tightbbox()] if box is not None])
    scale = DPI / sheet.figure.dpi
    left, right = (max(round(scale * edge), 0) for edge in (box.x0 - 6, box.x1 + 6))
    top, bottom = (max(len(pixels) - round(scale * edge), 0) for edge in (box.y1 + 6, box.y0 - 6))
    cut = io.BytesIO()
    imsave(cut, np.ascontiguousarray(pixels[top:bottom, left:right, :3]), format='png')
    return cut.getvalue()


def _draw_lessons(axes: Axes, task: Task, taught: list[EpisodeTrack], fallen: set[int]) -> None:
    shown = _error_shown(task)
    axes.set(title='Taught: the ball in each episode', xlabel='Time in the episode (s)',
             ylabel='Ball position error (cm)', ylim=(-shown, shown))
    if not taught:
        say_empty(axes, 'no finished episode in the bag')
        return
    _draw_goal(axes, task)
    numbers = [track.number for track in taught]
    colours = Normalize(min(numbers), max(max(numbers), min(numbers) + 1))
    for index, track in enumerate(taught):
        colour = SEQUENCE(0.92 * (1.0 - colours(track.number)))
        stands_out = len(taught) <= 2 * ENDS_SHOWN or not ENDS_SHOWN <= index < len(taught) - ENDS_SHOWN
        axes.plot(track.seconds, 100 * track.position_error, color=colour, alpha=0.9 if stands_out else 0.15)
        if track.number in fallen:
            axes.plot(track.seconds[-1], np.clip(100 * track.position_error[-1], -shown, shown),
                      'x', color=colour, markeredgewidth=2.5, markersize=9, clip_on=False)
    if fallen:
        axes.legend(handles=[cross(FAINT, 'the ball fell')], loc='lower right')
    if len(taught) > 1:
        _draw_scale(axes, colours)


def _draw_test_tracks(axes: Axes, task: Task, test: FinalTest | None) -> None:
    axes.set(title='Alone: the final test', xlabel='Time in the episode (s)')
    axes.set_ylabel('Ball position error (cm)')
    tracks = [episode for episode in test.episodes if episode.track] if test else []
    if test is None or not tracks:
        say_empty(axes, 'not tested' if test is None else 'no tracks were kept; results below')
        return
    axes.set_title(f'Alone: {test.successes} of {len(test.episodes)} tests succeed')
    _draw_goal(axes, task)
    shown = _error_shown(task)
    for episode in tracks:
        seconds = np.arange(len(episode.track)) * test.sample_period
        colour = GOOD if episode.success else BAD
        axes.plot(seconds, 100 * np.array(episode.track), color=colour, alpha=0.75, linewidth=1.4)
        if not episode.kept:
            axes.plot(seconds[-1], np.clip(100 * episode.track[-1], -shown, shown), 'x', color=colour,
                      markeredgewidth=2.5, markersize=9, clip_on=False)
    if not all(episode.kept for episode in tracks):
        axes.legend(handles=[cross(BAD, 'the ball fell')], loc='lower right')


def _draw_lessons_from_above(axes: Axes, task: Task, taught: list[EpisodeTrack], fallen: set[int]) -> None:
    axes.set_title('Taught: the ball in each episode, from above')
    if not taught:
        say_empty(axes, 'no finished episode in the bag')
        return
    draw_tray(axes, task.scene)
    numbers = [track.number for track in taught]
    colours = Normalize(min(numbers), max(max(numbers), min(numbers) + 1))
    for index, track in enumerate(taught):
        stands_out = len(taught) <= 2 * ENDS_SHOWN or not ENDS_SHOWN <= index < len(taught) - ENDS_SHOWN
        draw_track(axes, task.scene, track.on_tray, SEQUENCE(0.92 * (1.0 - colours(track.number))),
                   0.9 if stands_out else 0.15, track.number in fallen)
    if len(taught) > 1:
        _draw_scale(axes, colours)


def _draw_test_from_above(axes: Axes, task: Task, test: FinalTest | None) -> None:
    axes.set_title('Alone: the final test, from above')
    tracks = [episode for episode in test.episodes if episode.path] if test else []
    if test is None or not tracks:
        say_empty(axes, 'not tested' if test is None else 'no tracks were kept; results below')
        return
    axes.set_title(f'Alone: {test.successes} of {len(test.episodes)} tests succeed')
    draw_tray(axes, task.scene)
    for episode in tracks:
        draw_track(axes, task.scene, np.array(episode.path), GOOD if episode.success else BAD, 0.75, not episode.kept)


def _draw_scale(axes: Axes, colours: Normalize) -> None:
    bar = axes.figure.colorbar(ScalarMappable(colours, SEQUENCE.reversed()), ax=axes, pad=0.02, aspect=30,
                               label='Episode (early to late)')
    bar.ax.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    bar.outline.set_visible(False)  # type: ignore[operator]


def _error_shown(task: Task) -> float:
    """The largest error that is drawn, cm."""
    return 100 * BEYOND * task.scene.half_length


def _draw_goal(axes: Axes, task: Task) -> None:
    radius = 100 * task.scene.goal_radius
    axes.axhspan(-radius, radius, color=GOOD, alpha=0.12, linewidth=0)
    axes.annotate(f'green: within {radius:g} cm of the goal', (0.995, 0.985), xycoords='axes fraction', ha='right',
                  va='top', fontsize=8.5, color=GOOD)
    axes.margins(x=0.01)


def _draw_moments(human: Axes, agent: Axes, bag: Bag | None, taught: list[EpisodeTrack]) -> None:
    human.set_title('Moments on the tray')
    human.tick_params(labelbottom=False)
    if bag is None or not taught or not (len(bag.human_applied.moment) and len(bag.agent_applied.moment)):
        for axes in (human, agent):
            say_empty(axes, 'nothing recorded')
        return
    starts = _on_one_axis(taught)
    bound = 1.0
    for axes, wrenches, colour, label in (
            (human, bag.human_applied, HUMAN, f'Human\n{_symbols(bag.task, "h")} (N m)'),
            (agent, bag.agent_applied, AGENT, f'Robot\n{_symbols(bag.task, "ai")} (N m)')):
        seconds, moments = _moments_of(bag, wrenches, taught, starts)
        explores = wrenches is bag.agent_applied
        for row, moment, shade in zip(bag.task.axes, moments.T, _shades(colour, len(bag.task.axes)), strict=True):
            name = f'$M_{AXIS_NAMES[row][-1]}$' if len(bag.task.axes) > 1 else ''
            axes.fill_between(*_envelope(seconds, moment), color=shade, linewidth=0.9, step='post',
                              alpha=0.3 if explores else 1.0 if not name else 0.75, label=None if explores else name)
            if explores:
                axes.plot(seconds, _moving_mean(moment), color=shade, linewidth=1.4,
                          label=f'{name} mean of 0.5 s'.strip())
        if explores or len(bag.task.axes) > 1:
            axes.legend(ncols=2, loc='upper right', borderpad=0, bbox_to_anchor=(1, 1.28))
        bound = max(bound, np.abs(moments).max(initial=0.0))
        axes.set_ylabel(label)
        axes.axhline(0, color=FAINT, linewidth=0.8)
        for index, (track, left) in enumerate(zip(taught, starts, strict=True)):
            right = left + _duration(track)
            axes.axvspan(left, right, color=FAINT, alpha=0.10 if index % 2 == 0 else 0.03, linewidth=0)
    if len(taught) <= 30:
        for track, left in zip(taught, starts, strict=True):
            human.annotate(str(track.number), (left, 1), xytext=(3, -2),
                           xycoords=('data', 'axes fraction'), textcoords='offset points', va='top',
                           fontsize=8.5, color=FAINT)
    human.set(ylim=(-1.12 * bound, 1.12 * bound), xlim=(0, right))
    agent.set_xlabel("Robot's time since the first episode (s); shaded and numbered: episodes")


def _on_one_axis(taught: list[EpisodeTrack]) -> list[float]:
    """Where each episode begins, s: the robot's time, but for where that was set, or stood for long."""
    starts = [0.0]
    for before, track in pairwise(taught):
        gap = (track.start_ns - before.end_ns) * 1e-9
        starts.append(starts[-1] + _duration(before) + (gap if 0.0 <= gap <= LONGEST_GAP else GAP))
    return starts


def _duration(track: EpisodeTrack) -> float:
    return (track.end_ns - track.start_ns) * 1e-9


def _moments_of(bag: Bag, wrenches: Wrenches, taught: list[EpisodeTrack], starts: list[float],
                ) -> tuple[np.ndarray, np.ndarray]:
    """The moments once a policy period, and when on the common axis: (n,), s, and (n, k), N m."""
    seconds, moments, drawn_until = [], [], 0.0
    between = cache(wrenches.between)  # most episodes are of one run, and each would sort all of it
    for track, start in zip(taught, starts, strict=True):
        own = between(run_window(bag, track.received_ns[0]))
        end = start + _duration(track)
        at = np.arange(drawn_until, end, POLICY_PERIOD)
        if len(own.stamp_ns):
            seconds.append(at)
            moments.append(own.moment_at(track.start_ns + np.round((at - start) * 1e9).astype(np.int64)))
        drawn_until = end
    if not seconds:
        return np.zeros(1), np.zeros((1, len(bag.task.axes)))
    return np.concatenate(seconds), np.concatenate(moments)


def _symbols(task: Task, who: str) -> str:
    return ', '.join(f'$M_{{{AXIS_NAMES[row][-1]}{who}}}$' for row in task.axes)


def _shades(colour: str, count: int) -> list[str]:
    """``colour`` for each of a task's axes: the last is as it is, the one before it darker."""
    red, green, blue = (0.55 * part for part in to_rgb(colour))
    return [colour] if count == 1 else [to_hex((red, green, blue)), *[colour] * (count - 1)]


def _envelope(seconds: np.ndarray, moment: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Starts of many short spans (s), lowest and highest moment (N m) in each."""
    if len(seconds) < 2:
        return seconds, moment, moment
    spans = np.searchsorted(seconds, np.linspace(0, seconds[-1], MOMENT_BINS), 'right') - 1
    firsts = np.unique(spans.clip(min=0))
    before = moment[np.maximum(firsts - 1, 0)]  # so that a step is drawn as a line from old to new
    return (seconds[firsts], np.minimum(np.minimum.reduceat(moment, firsts), before),
            np.maximum(np.maximum.reduceat(moment, firsts), before))


def _moving_mean(moment: np.ndarray) -> np.ndarray:
    """Mean over half a second around each moment (one a policy period), N m."""
    weights = np.ones(round(0.5 / POLICY_PERIOD))
    return np.convolve(moment, weights, 'same') / np.convolve(np.ones_like(moment), weights, 'same')


def _draw_returns(axes: Axes, rows: list[EpisodeRow]) -> None:
    axes.set(title='Return by episode', xlabel='Episode', ylabel='Return (sum of rewards)')
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    points = [(row.number, row.episode_return, row.fallen) for row in rows if row.episode_return is not None]
    if not points:
        say_empty(axes, 'no episodes')
        return
    numbers, returns, fell = zip(*points, strict=True)
    axes.plot(numbers, returns, '-', color=AGENT, alpha=0.5)
    kept = [not f for f in fell]
    axes.plot(np.array(numbers)[kept], np.array(returns)[kept], 'o', color=AGENT, markersize=6)
    if any(fell):
        down = np.array([bool(f) for f in fell])
        axes.plot(np.array(numbers)[down], np.array(returns)[down], 'x', color=AGENT, markeredgewidth=2.2, markersize=7)
        axes.legend(handles=[cross(AGENT, 'the ball fell')], loc='lower right', bbox_to_anchor=(1, 1), borderpad=0)
    axes.margins(x=0.08, y=0.12)


def _draw_shares(axes: Axes, rows: list[EpisodeRow]) -> None:
    axes.set(title='Human share by episode', xlabel='Episode', ylabel='Human share of the moment (%)', ylim=(0, 100))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    points = [(row.number, 100 * row.human_share) for row in rows if row.human_share is not None]
    if not points:
        say_empty(axes, 'no episodes')
        return
    numbers, shares = zip(*points, strict=True)
    axes.bar(numbers, shares, color=HUMAN, width=0.7)
    axes.grid(visible=False, axis='x')
    if len(points) <= 12:
        for number, share in points:
            axes.annotate(f'{share:.0f}', (number, share), xytext=(0, 2), textcoords='offset points', ha='center',
                          fontsize=9)


def _draw_test_results(axes: Axes, test: FinalTest | None) -> None:
    axes.set(title='Alone: error at the end', xlabel='Position error at the start (cm)',
             ylabel='Mean |error| of the last 3 s (cm)')
    if test is None or not test.episodes:
        say_empty(axes, 'not tested')
        return
    limit = 100 * test.position_error_max
    top = max(2 * limit, 1.2 * max((100 * e.position_error for e in test.episodes if e.kept), default=0.0))
    axes.axhspan(0, limit, color=GOOD, alpha=0.12, linewidth=0)
    for episode in test.episodes:
        colour = GOOD if episode.success else BAD
        marker = 'o' if episode.success else '^' if episode.kept else 'x'  # told apart without colours, too
        height = min(100 * episode.position_error, top)
        axes.plot(100 * episode.ball_start, height, marker, color=colour, clip_on=False,
                  markersize=7, markeredgewidth=1.0 if episode.kept else 2.5, alpha=0.85)
    axes.set_ylim(0, top)
    axes.annotate(f'success: under {limit:.0f} cm, and at rest', (0.99, limit), xycoords=('axes fraction', 'data'),
                  xytext=(0, 3), textcoords='offset points', ha='right', va='bottom', fontsize=8.5, color=GOOD)
