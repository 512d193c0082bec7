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

"""The report of a session: picture.png, summary.json and report.html, from what is in its folder."""

import base64
import json
from datetime import datetime
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup
from shared_control.files import write_atomically
from shared_control.tasks.balance import BALANCE

from ..bag.ball_tracks import episode_tracks
from ..bag.reader import Bag, BagReadError, read_bag
from ..bag.task import recorded_task
from ..plotting.plot import origin
from .episodes import EpisodeRow, read_episodes
from .final_test import FinalTest, load_test
from .folder import SessionFolder
from .picture import Panel, draw_picture
from .summary import Summary, earlier_restarts, summarize

_PAGE = Path(__file__).parent / 'page.html'
STYLE_SHEET = Path(__file__).with_name('page.css')
"""Style sheet of this page and of other reports."""
_NOT_ALONE = 'Nobody was to teach, but somebody pressed keys or pushed.'
_NOT_KNOWN = '–'


def write_report(folder: SessionFolder, restarts: int | None = None, bag: Bag | None = None) -> Summary:
    """Write picture, summary and report; what is missing in the folder is left out of them.

    Args:
        folder: of a session that has ended.
        restarts: how often a node was started again; when None, what an earlier report says.
        bag: the folder's, when it was read already.

    Raises:
        ValueError: a file of the session is damaged; the message names it.
        OSError: the same, or the folder cannot be written.
    """
    if restarts is None:
        restarts = earlier_restarts(folder)
    bag, bag_error = (bag, None) if bag else _read(folder)
    rows, test = read_episodes(folder.episodes), load_test(folder.test)
    task = bag.task if bag else recorded_task(folder.bag) or BALANCE
    summary = summarize(folder, task, bag, bag_error, rows, test, restarts)
    tracks = episode_tracks(bag) if bag else []
    panels = draw_picture(folder.picture, _title(summary), _origin(summary), bag, tracks, rows, test, task)
    write_atomically(folder.summary, (json.dumps(summary.as_dict(), indent=2) + '\n').encode())
    write_atomically(folder.report, render_page(summary, rows, test, panels).encode())
    return summary


def render_page(summary: Summary, rows: list[EpisodeRow], test: FinalTest | None, panels: list[Panel]) -> str:
    """The report as one HTML page that needs no other file."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    environment.filters['number'] = _number
    environment.filters['percent'] = lambda share: _number(None if share is None else 100 * share, '.0f')
    environment.filters['base64'] = lambda content: base64.b64encode(content).decode()
    return environment.from_string(_PAGE.read_text(encoding='utf-8')).render(
        css=Markup(STYLE_SHEET.read_text(encoding='utf-8')), title=_title(summary), s=summary, rows=rows, test=test,
        judged=any(row.verdict for row in rows),
        learned_alone=_learned_alone(summary, rows), not_alone=_NOT_ALONE,
        figures=_figures(summary), done=_done(summary, rows), panels=panels, origin=_origin(summary))


def _read(folder: SessionFolder) -> tuple[Bag | None, str | None]:
    """The bag, or why it cannot be read."""
    if not folder.bag.exists():
        return None, None
    try:
        return read_bag(folder.bag), None
    except BagReadError as error:
        return None, str(error)


def _origin(summary: Summary) -> str:
    """Where report and picture come from: version, seed, day of the recording."""
    return origin(summary.seed, datetime.fromisoformat(summary.recorded).date() if summary.recorded else None)


def _tutor(summary: Summary) -> str:
    """Who taught, as a part of a sentence."""
    if summary.tutor is None:
        return 'unknown'
    if summary.simulated_tutor:
        return f'simulated tutor ({summary.tutor.removeprefix("simulated: ")})'
    known = {'none': 'no tutor', 'keyboard': 'person at the keyboard', 'page': 'person on the page'}
    return known.get(summary.tutor, f'tutor ({summary.tutor})')


def _title(summary: Summary) -> str:
    parts = [summary.task, summary.preset or 'unknown preset', _tutor(summary) if summary.tutor else 'unknown tutor']
    if summary.autonomous_success is not None:
        parts.append(f'alone {summary.autonomous_success} of {summary.autonomous_episodes}')
    return 'Session: ' + ' · '.join(parts)


def _learned_alone(summary: Summary, rows: list[EpisodeRow]) -> bool:
    """Whether nobody was to teach, and nobody has done it either."""
    return summary.tutor == 'none' and not summary.key_presses and not any(row.human_share for row in rows)


def _done(summary: Summary, rows: list[EpisodeRow]) -> str:
    """What was done, in a sentence or two."""
    episodes = 'episode' if summary.episodes_taught == 1 else 'episodes'
    text = (f'The robot learned the task {summary.task} in {_number(summary.episodes_taught, "d")} {episodes} (preset '
            f'{summary.preset or "unknown"}). ')
    if summary.episodes_broken_off:
        text += f'Episodes broken off, from which it has not learned: {summary.episodes_broken_off}. '
    if _learned_alone(summary, rows):
        text += 'Nobody pressed keys.'
    elif summary.tutor == 'none':
        text += f'{_NOT_ALONE}{_in_the_hand(summary)}'
    else:
        text += (f'Tutor: {_tutor(summary)}, whose moment adds to the one that the robot puts on the tray.'
                 f'{_in_the_hand(summary)}')
    if summary.autonomous_success is not None:
        text += f' Then the policy was tested alone, in {summary.autonomous_episodes} episodes of random starts.'
    return text


def _in_the_hand(summary: Summary) -> str:
    return f' In the hand: {", ".join(summary.devices)}.' if summary.devices else ''


def _figures(summary: Summary) -> list[tuple[str, str]]:
    """The headline figures: value and what it is."""
    success = (_NOT_KNOWN if summary.autonomous_success is None
               else f'{summary.autonomous_success} / {summary.autonomous_episodes}')
    return [(success, 'tests alone succeed'), (_number(summary.episodes_taught, 'd'), 'episodes taught'),
            (_number(summary.key_presses, 'd'), 'key presses'), (_duration(summary.duration_s), 'recorded')]


def _number(value: Any, form: str) -> str:
    return _NOT_KNOWN if value is None else format(value, form).replace('-', '−')


def _duration(seconds: float | None) -> str:
    if seconds is None:
        return _NOT_KNOWN
    minutes, rest = divmod(round(seconds), 60)
    return f'{minutes} min {rest} s' if minutes else f'{rest} s'
