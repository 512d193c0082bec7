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

"""What stands where on the page. What moves is moved by ``static/page.js``, which finds it by ``data-part``."""

import json
from html import escape
from typing import Any

from nicegui import ui
from shared_control.keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, Key, count_buttons
from shared_control.scene import Scene
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.wrench import AXIS_NAMES
from shared_control_ros.watching.words import (
    NO_LESSON,
    STANDS_STILL,
    STARTING,
    STUCK,
    STUCK_SECONDS,
    practice_words,
    words_for,
)

from .arm_scene import build_scene
from .from_above import view_from_above
from .replay_desk import CHART_SECONDS
from .showing import Showing

_KEYS = {Key.LEFT: ('←', 'push left'), Key.UP: ('↑', 'push away'), Key.SPACE: ('␣', 'no push'),
         Key.DOWN: ('↓', 'push near'), Key.RIGHT: ('→', 'push right')}
"""In the order in which they stand on the page."""
_MOMENTS = (('human', 'you'), ('agent', 'robot'), ('applied', 'together'))
_NOTCHES = round(HUMAN_MOMENT_LIMIT / KEYSTROKE)
"""How many presses the largest push takes."""
RESTS_MAX = 100
"""The largest practice_rests of the agent."""
_HUMAN, _AGENT, _SUM = '#c2410c', '#0b63a5', '#495057'


def build(is_replay: bool, task: Task = BALANCE, showing: Showing = Showing()) -> None:
    """One page, for ``task``."""
    ui.add_head_html('<script>document.documentElement.lang = "en"</script>'  # NiceGUI does not say it
                     '<link rel="stylesheet" href="/static/page.css">'
                     '<script type="module" src="/static/no_graphics_card.js"></script>')
    from_above = len(task.axes) > 1
    kind = f'{"replay" if is_replay else "live"} {"two-axes" if from_above else "one-axis"}'
    ui.query('body').classes(f'{kind} feedback-{showing.feedback}')
    with ui.element('div').classes('lesson'):
        _header(is_replay, showing)
        with ui.element('section').classes('stage').props('aria-label="The tray"'):
            scene = build_scene(task).classes('scene').props(
                'data-part=scene role=img aria-label="The arm with the tray and the ball, in 3D"')
            with ui.element('div').classes('close-view'):
                _moments()
                drawing = view_from_above(task.scene) if from_above else _close_view(task.scene)
                ui.html(drawing, sanitize=False).classes('drawing')
            _card()
            if is_replay:
                _player()
            else:
                _keys(task)
        with ui.element('aside').props('aria-label="The lesson"'):
            _help(is_replay, task, showing)
            charts = _charts(task, from_above)
            if not is_replay:
                _buttons(showing)
    if not is_replay:
        _end_card('Thank you.' if showing.in_session and not showing.shows_result else 'Thank you, you are finished.')
    _part('focus', 'button').classes('veil').props('aria-label="Click here to teach"')
    words = {**_numbers(task), 'scene': scene.id, **{name: chart.id for name, chart in charts.items()},
             **_words(task, showing)}
    ui.add_body_html(f'<script>window.teachPage = {json.dumps(words)}</script>'
                     '<script type="module" src="/static/page.js"></script>')


def _numbers(task: Task) -> dict[str, Any]:
    """What the page's scripts take from the task: lengths, m; durations, s; moments, N m."""
    tray = task.scene
    return {'half_length': tray.half_length, 'half_width': tray.half_width, 'surface': tray.surface,
            'axes': list(task.axes), 'keys': [key.name.lower() for key in list(Key)[:count_buttons(task.keys)]],
            'pushes': {key.name.lower(): [axis, sign] for key, (axis, sign) in task.keys.items()},
            'keystroke': KEYSTROKE, 'goal': list(tray.goal), 'moment_limit': float(task.limit.max()),
            'chart_seconds': CHART_SECONDS}


def _words(task: Task, showing: Showing) -> dict[str, Any]:
    nothing = STARTING if showing.in_session else NO_LESSON
    return {'words': {**words_for(task), 'nothing': nothing},
            'goes_on': showing.in_session and not showing.shows_result,
            'verdicts': showing.verdicts, 'stands_still': STANDS_STILL, 'stuck': STUCK, 'stuck_seconds': STUCK_SECONDS,
            'practice': [practice_words(left) for left in range(RESTS_MAX + 1)],
            'marks': showing.marks, 'tested': showing.tested}


def _part(name: str, tag: str = 'div') -> ui.element:
    return ui.element(tag).props(f'data-part={name}')


def _text(name: str, text: str = '', tag: str = 'div') -> ui.html:
    return ui.html(escape(text), sanitize=False, tag=tag).props(f'data-part={name}')


def _header(is_replay: bool, showing: Showing) -> None:
    with ui.element('header'):
        _text('phase', 'Connecting …', 'h1').classes('phase')
        _text('doing').classes('doing').props('role=status aria-live=polite')
        with ui.element('div').classes('clock'):
            _text('time-left')
            with ui.element('div').classes('bar'):
                _part('time-bar')
        with _part('score').classes('score').props('hidden'):
            ui.label('robot alone')
            _text('success', showing.tested)
        if is_replay:
            _text('of', showing.title).classes('role')
        _text('role').classes('role').props('role=status')


def _keys(task: Task) -> None:
    with ui.element('div').classes('keys').props('role=group aria-label="Keys"'):
        for key, (sign, what) in _KEYS.items():
            if key is not Key.SPACE and key not in task.keys:
                continue
            with ui.element('button').classes('key').props(f'data-key={key.name.lower()} type=button'):
                ui.label(sign).classes('sign').props('aria-hidden=true')
                ui.label(what)
                if key is not Key.SPACE:
                    with ui.element('div').classes('notches').props('aria-hidden=true'):
                        for _ in range(_NOTCHES):
                            ui.element('i')
    _text('push').classes('push').props('role=status')


def _player() -> None:
    with ui.element('div').classes('player').props('role=group aria-label="Player"'):
        _button('play', 'Play')
        _button('previous', '◂ episode', label='previous episode')
        _button('next', 'episode ▸', label='next episode')
        with ui.element('div').classes('track'):
            ui.element('input').props(
                'data-part=slider type=range min=0 max=1 step=0.01 value=0 aria-label="Time in the recording"')
            _part('marks').classes('marks').props('aria-hidden=true')
        _text('position')
        with ui.element('select').props('data-part=speed aria-label="Speed"'):
            for speed in ('0.25', '0.5', '1', '2', '4', '8'):
                ui.html(f'{speed} ×', sanitize=False, tag='option').props(f'value={speed}')


def _help(is_replay: bool, task: Task, showing: Showing) -> None:
    live = _HELP if len(task.axes) == 1 else (
        f'{escape(task.instruction)} The goal is the <b class="goal">green disc</b>.', *_HELP_FROM_ABOVE)
    with ui.element('ol').classes('help'):
        for line in _REPLAY_HELP if is_replay else live + _HELP_TO_JUDGE * showing.verdicts:
            ui.html(line, sanitize=False, tag='li')


def _moments() -> None:
    with ui.element('div').classes('moments'):
        for name, who in _MOMENTS:
            with ui.element('div').classes(name):
                _text(f'{name}-name', who)
                _text(f'{name}-moment', '–').classes('number')


def _card() -> None:
    """What stands over the arm between two episodes."""
    with _part('card').classes('card').props('hidden'):
        _text('card-outcome').props('role=status aria-live=polite').classes('outcome')
        _text('card-next').classes('next')


def _charts(task: Task, from_above: bool) -> dict[str, ui.echart]:
    with ui.element('div').classes('charts'):
        title = 'Push of each, N m (about x dashed)' if from_above else 'Push of each, N m'
        return {'moments': _chart('moments', title, _moment_options(task)),
                'returns': _chart('returns', 'Score of each episode', _episode_options(_AGENT)),
                'shares': _chart('shares', 'Human share of each episode, %', _episode_options(_HUMAN, 100))}


def _chart(name: str, title: str, options: dict[str, Any]) -> ui.echart:
    with ui.element('div').classes(f'chart {name}'):
        ui.label(title)
        return ui.echart(options).props(f'role=img aria-label="{title}"')


def _buttons(showing: Showing) -> None:
    """*Done* is never where *Start* was, nor *Yes* where *Done* was."""
    with ui.element('div').classes('buttons').props('role=group aria-label="The lesson"'):
        with ui.element('div').classes('first'):
            _button('start', 'Start teaching').classes('main')
            _button('take-seat', 'Teach from here').classes('main')
        _button('pause', 'Pause', 'everything waits')
        _button('repeat', 'Repeat', 'same ball again')
        _button('stop', 'Stop', 'end, keep all')
        if showing.verdicts:
            with _part('judge').classes('judge').props('hidden role=group aria-labelledby=judged'):
                _text('judged').props('id=judged')
                _button('judge-success', 'Good', 'key g')
                _button('judge-failure', 'Bad', 'key b')
                _button('judge-discard', 'Discard', 'key x')
        with ui.element('div').classes('last'):
            _button('finish', 'Done teaching: test the robot')
            with _part('sure').classes('sure').props('hidden role=group aria-label="End the teaching?"'):
                ui.label('End the teaching with this episode?')
                _button('no', 'No, go on teaching')
                _button('yes', 'Yes, test the robot')
            with _part('ending').classes('sure').props('hidden'):
                ui.label('The teaching ends with this episode.').props('role=status')
                _button('keep-teaching', 'Go on teaching instead')


def _button(name: str, text: str, what: str = '', label: str = '') -> ui.element:
    named = f' aria-label="{label}"' if label else ''
    with ui.element('button').props(f'data-part={name} type=button{named}') as button:
        _text(f'{name}-text', text, 'span')
        if what:
            ui.html(what, sanitize=False, tag='small')
    return button


def _end_card(title: str) -> None:
    with _part('end').classes('end').props('hidden role=dialog aria-labelledby=end-title'), ui.element('div'):
        ui.html(title, sanitize=False, tag='h2').props('id=end-title tabindex=-1')
        _text('end-words').classes('result').props('role=status aria-live=polite')
        ui.element('img').props('data-part=end-picture hidden alt="What happened in the session, in one picture"')
        with ui.element('div').classes('choices'):
            ui.html('Open the report', sanitize=False, tag='a').props(
                'data-part=end-report hidden href=/session/report.html target=_blank')
            _button('close', 'Close').props('hidden')


def _axes() -> dict[str, Any]:
    return {'animation': False, 'grid': {'left': 42, 'right': 10, 'top': 8, 'bottom': 22},
            'tooltip': {'trigger': 'axis', 'confine': True}}


def _moment_options(task: Task) -> dict[str, Any]:
    bound = float(task.limit.max())
    series = [(f'{name} {AXIS_NAMES[row][-1]}' if len(task.axes) > 1 else name, colour, width, row, dash)
              for name, colour, width, dash in (('human', _HUMAN, 3, 'solid'), ('robot', _AGENT, 1.5, 'solid'),
                                                ('together', _SUM, 1, 'dotted'))
              for row in task.axes]
    lines = 1 if len(task.axes) == 1 else 2  # of the legend
    return {**_axes(), 'grid': {'left': 42, 'right': 10, 'top': 6 + 18 * lines, 'bottom': 22},
            'legend': {'top': 0, 'left': 42, 'right': 8, 'itemHeight': 8, 'itemWidth': 18, 'itemGap': 8,
                       'textStyle': {'fontSize': 11}},
            'xAxis': {'type': 'value', 'min': -CHART_SECONDS, 'max': 0, 'interval': 5,
                      'axisLabel': {'formatter': '{value} s'}},
            'yAxis': {'type': 'value', 'min': -bound, 'max': bound, 'interval': bound},
            'series': [{'name': name, 'type': 'line', 'step': 'end', 'symbol': 'none', 'data': [],
                        'lineStyle': {'color': colour, 'width': width,
                                      'type': dash if row == task.axes[-1] else 'dashed'},
                        'itemStyle': {'color': colour}}
                       for name, colour, width, row, dash in series]}


def _episode_options(colour: str, top: float | None = None) -> dict[str, Any]:
    return {**_axes(),
            'xAxis': {'type': 'category', 'data': []},
            'yAxis': {'type': 'value', 'scale': top is None, 'min': None if top is None else 0, 'max': top,
                      'splitNumber': 1, **({} if top is None else {'interval': top})},  # room for labels when low
            'series': [{'type': 'line', 'data': [], 'symbolSize': 6, 'lineStyle': {'color': colour},
                        'itemStyle': {'color': colour}, 'areaStyle': {'opacity': 0.12}}]}


_STAYS = 'each press adds a notch of push, and the push <b>stays</b>. <kbd>space</kbd> takes it all away.'
_HELP = (
    'Bring the ball to rest on the <b class="goal">green mark</b> in the middle.',
    f'<kbd>←</kbd> and <kbd>→</kbd>: {_STAYS}',
    "A gamepad's stick, or a finger that pulls the drawing, pushes as far as it is held.",
    'Push when the robot errs; take your push away when it does well. <kbd>p</kbd> pauses.')
_HELP_TO_JUDGE = (
    'The last episode was <kbd>g</kbd> good, <kbd>b</kbd> bad, or <kbd>x</kbd> is to be forgotten; the same key again '
    'takes that back.',)
_HELP_FROM_ABOVE = (f'<kbd>←</kbd> <kbd>↑</kbd> <kbd>↓</kbd> <kbd>→</kbd>: {_STAYS}', *_HELP[2:])
_REPLAY_HELP = (
    '<kbd>space</kbd> plays and pauses; the slider goes anywhere, its marks are episodes.',
    '<kbd>←</kbd> and <kbd>→</kbd> go back and on by 5 s.',
    'The orange arrow is the push of the person, the blue one the push of the robot.')


def _close_view(tray: Scene) -> str:
    """The tray from the front, 1 mm a unit; base +x is on the left."""
    half, wall, goal, radius = (1000 * length for length in (
        tray.half_length, tray.wall, tray.goal_radius, tray.ball.radius))
    return f"""
<svg viewBox="{-half - 40} -100 {2 * half + 80} 230" data-part="close-view" role="img"
    aria-label="The tray from the front">
  <line x1="{-half - 38}" x2="{half + 38}" y1="0" y2="0" class="level"/>
  <g data-part="tilt">
    <rect x="{-half - 5}" y="0" width="{2 * half + 10}" height="8" rx="2" class="tray"/>
    <rect x="{-half - 5}" y="{-wall - 2}" width="6" height="{wall + 4}" class="tray"/>
    <rect x="{half - 1}" y="{-wall - 2}" width="6" height="{wall + 4}" class="tray"/>
    <rect x="{-goal}" y="0" width="{2 * goal}" height="8" class="goal"/>
    <ellipse data-part="close-shadow" cy="0.5" rx="{radius - 1}" ry="3" class="shadow"/>
    <circle data-part="close-ball" r="{radius}" class="ball"/>
  </g>
  <text x="{-half - 38}" y="-86" data-part="tilt-text" class="tilt-text"></text>
  <g class="arrows">
    <line x1="0" x2="0" y1="76" y2="128" class="level"/>
    <path data-part="arrow-human" transform="translate(0 85)" class="human"/>
    <path data-part="arrow-agent" transform="translate(0 102)" class="agent"/>
    <path data-part="arrow-applied" transform="translate(0 120)" class="applied"/>
  </g>
</svg>"""
