"""What stands where on the page. What moves is moved by ``static/page.js``, which finds it by ``data-part``."""

import json
from html import escape
from typing import Any

from nicegui import ui
from shared_control.keys import Key, count_buttons
from shared_control.scene import Scene
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.wrench import AXIS_NAMES

from .arm_scene import build_scene
from .from_above import view_from_above

CHART_SECONDS = 15
"""How far back the chart of the moments reaches, s."""
_KEYS = {Key.LEFT: ('←', 'tip left'), Key.UP: ('↑', 'tip away'), Key.SPACE: ('␣', 'let go'),
         Key.DOWN: ('↓', 'tip near'), Key.RIGHT: ('→', 'tip right')}
"""In the order in which they stand on the page."""
_MOMENTS = (('human', 'you'), ('agent', 'robot'), ('applied', 'together'))


def build(is_replay: bool, task: Task = BALANCE) -> None:
    """One page, for ``task``."""
    ui.add_head_html('<link rel="stylesheet" href="/static/page.css">'
                     '<script type="module" src="/static/no_graphics_card.js"></script>')
    from_above = len(task.axes) > 1
    ui.query('body').classes(f'{"replay" if is_replay else "live"} {"two-axes" if from_above else "one-axis"}')
    with ui.element('main'):
        _header()
        with ui.element('section').classes('stage'):
            scene = build_scene(task).classes('scene').props('data-part=scene')
            with ui.element('div').classes('close-view'):
                _moments()
                drawing = view_from_above(task.scene) if from_above else _close_view(task.scene)
                ui.html(drawing, sanitize=False).classes('drawing')
            if is_replay:
                _player()
            else:
                _keys(task)
        with ui.element('aside'):
            _help(is_replay, task)
            title = 'Moments, N m (about x dashed)' if from_above else 'Moments, N m'
            charts = {'moments': _chart(title, _moment_options(task)),
                      'returns': _chart('Return of each episode', _episode_options('#4263eb')),
                      'shares': _chart('Human share of each episode, %', _episode_options('#e8590c', 100))}
            if not is_replay:
                _buttons()
    _part('focus', 'button').classes('veil')
    words = {**_numbers(task), 'scene': scene.id, **{name: chart.id for name, chart in charts.items()}}
    ui.add_body_html(f'<script>window.teachPage = {json.dumps(words)}</script>'
                     '<script type="module" src="/static/page.js"></script>')


def _numbers(task: Task) -> dict[str, Any]:
    """What the page's scripts take from the task: lengths, m; durations, s; moments, N m."""
    tray = task.scene
    return {'half_length': tray.half_length, 'half_width': tray.half_width, 'surface': tray.surface,
            'axes': list(task.axes), 'keys': [key.name.lower() for key in list(Key)[:count_buttons(task.keys)]],
            'goal': list(tray.goal), 'moment_limit': float(task.limit.max()), 'chart_seconds': CHART_SECONDS,
            'episode_seconds': {'teach': task.episode_seconds, 'test': task.test_seconds}}


def _part(name: str, tag: str = 'div') -> ui.element:
    return ui.element(tag).props(f'data-part={name}')


def _text(name: str, text: str = '') -> ui.label:
    return ui.label(text).props(f'data-part={name}')


def _header() -> None:
    with ui.element('header'):
        _text('phase', 'Connecting …').classes('phase')
        _text('doing').classes('doing')
        with ui.element('div').classes('clock'):
            _text('time-left')
            with ui.element('div').classes('bar'):
                _part('time-bar')
        with ui.element('div').classes('score'):
            ui.label('robot alone, last test')
            _text('success', 'not yet')
        _text('role').classes('role')


def _keys(task: Task) -> None:
    with ui.element('div').classes('keys'):
        for key, (sign, what) in _KEYS.items():
            if key is not Key.SPACE and key not in task.keys:
                continue
            with ui.element('button').classes('key').props(f'data-key={key.name.lower()} tabindex=-1'):
                ui.label(sign).classes('sign')
                ui.label(what)


def _player() -> None:
    with ui.element('div').classes('player'):
        _button('play', 'Play')
        ui.element('input').props('data-part=slider type=range min=0 max=1 step=0.01 value=0')
        _text('position')
        with ui.element('select').props('data-part=speed'):
            for speed in ('0.25', '0.5', '1', '2', '4', '8'):
                ui.html(f'{speed} ×', sanitize=False, tag='option').props(f'value={speed}')


def _help(is_replay: bool, task: Task) -> None:
    live = _HELP if len(task.axes) == 1 else (
        f'{escape(task.instruction)} The goal is <b class="goal">green</b>.', *_HELP_FROM_ABOVE)
    with ui.element('ol').classes('help'):
        for line in _REPLAY_HELP if is_replay else live:
            ui.html(line, sanitize=False, tag='li')


def _moments() -> None:
    with ui.element('div').classes('moments'):
        for name, who in _MOMENTS:
            with ui.element('div').classes(name):
                _text(f'{name}-name', who)
                _text(f'{name}-moment', '–').classes('number')


def _chart(title: str, options: dict[str, Any]) -> ui.echart:
    with ui.element('div').classes('chart'):
        ui.label(title)
        return ui.echart(options)


def _buttons() -> None:
    with ui.element('div').classes('buttons'):
        _button('pause', 'Pause')
        _button('repeat', 'Repeat')
        _button('stop', 'Stop')
        _button('start', 'Start teaching').classes('main')
        _button('finish', 'It has learned it').classes('main')
        _button('take-seat', 'Teach from here').classes('main')


def _button(name: str, text: str) -> ui.element:
    with ui.element('button').props(f'data-part={name} tabindex=-1') as button:
        ui.label(text)
    return button


def _axes() -> dict[str, Any]:
    return {'animation': False, 'grid': {'left': 42, 'right': 10, 'top': 8, 'bottom': 22},
            'tooltip': {'trigger': 'axis', 'confine': True}}


def _moment_options(task: Task) -> dict[str, Any]:
    bound = float(task.limit.max())
    series = [(f'{name} {AXIS_NAMES[row][-1]}' if len(task.axes) > 1 else name, colour, width, row)
              for name, colour, width in (('human', '#e8590c', 2), ('robot', '#4263eb', 1), ('together', '#868e96', 1))
              for row in task.axes]
    return {**_axes(),
            'xAxis': {'type': 'value', 'min': -CHART_SECONDS, 'max': 0, 'interval': 5,
                      'axisLabel': {'formatter': '{value} s'}},
            'yAxis': {'type': 'value', 'min': -bound, 'max': bound, 'interval': bound / 2},
            'series': [{'name': name, 'type': 'line', 'step': 'end', 'symbol': 'none', 'data': [],
                        'lineStyle': {'color': colour, 'width': width,
                                      'type': 'solid' if row == task.axes[-1] else 'dashed'},
                        'itemStyle': {'color': colour}}
                       for name, colour, width, row in series]}


def _episode_options(colour: str, top: float | None = None) -> dict[str, Any]:
    return {**_axes(),
            'xAxis': {'type': 'category', 'data': []},
            'yAxis': {'type': 'value', 'scale': top is None, 'min': None if top is None else 0, 'max': top,
                      'splitNumber': 2},
            'series': [{'type': 'line', 'data': [], 'symbolSize': 6, 'lineStyle': {'color': colour},
                        'itemStyle': {'color': colour}, 'areaStyle': {'opacity': 0.12}}]}


_HELP = (
    'Bring the ball to rest on the <b class="goal">green middle</b>.',
    '<kbd>←</kbd> and <kbd>→</kbd> tip the tray, more with each press; <kbd>space</kbd> lets go.',
    'Correct the robot when it errs, let go when it does well.')
_HELP_FROM_ABOVE = (
    '<kbd>←</kbd> <kbd>↑</kbd> <kbd>↓</kbd> <kbd>→</kbd> tip the plate, more with each press; <kbd>space</kbd> lets '
    'go.',
    _HELP[2])
_REPLAY_HELP = (
    '<kbd>space</kbd> plays and holds; the slider goes anywhere.',
    '<kbd>←</kbd> and <kbd>→</kbd> go back and on by 5 s.',
    'The orange arrow is what the teacher did, the blue one what the robot did.')


def _close_view(tray: Scene) -> str:
    """The tray from the front, 1 mm a unit; base +x is on the left."""
    half, wall, goal, radius = (1000 * length for length in (
        tray.half_length, tray.wall, tray.goal_radius, tray.ball.radius))
    return f"""
<svg viewBox="{-half - 40} -60 {2 * half + 80} 168" data-part="close-view" role="img"
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
  <text x="{-half - 38}" y="-46" data-part="tilt-text" class="tilt-text"></text>
  <g class="arrows">
    <line x1="0" x2="0" y1="46" y2="98" class="level"/>
    <path data-part="arrow-human" transform="translate(0 55)" class="human"/>
    <path data-part="arrow-agent" transform="translate(0 72)" class="agent"/>
    <path data-part="arrow-applied" transform="translate(0 91)" class="applied"/>
  </g>
</svg>"""
