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

"""The teaching screen as lines of text: a pure function of the scene and the size of the window."""

import math
import re

from shared_control.keys import COUNT_IN
from shared_control.verdict import Verdict
from shared_control.wrench import AXIS_NAMES
from shared_control_ros.watching.scene import Scene
from shared_control_ros.watching.words import (
    NO_LESSON,
    STANDS_STILL,
    STARTING,
    STUCK,
    STUCK_SECONDS,
    Words,
    practice_words,
    words_for,
)

from .picture import STEEPER, draw

_MIN_PICTURE = 5
"""Lines; less important lines go before the picture gets smaller, except in a tiny window."""
_SPARKS = {True: '▁▂▃▄▅▆▇█', False: '_.-:=+*#'}
_TIME_CELLS = 10
"""Length of the bar of the time left."""
_ARROWS = {True: ('←', '→'), False: ('<-', '->')}


def render(scene: Scene, width: int, height: int, unicode: bool = True) -> list[str]:
    """The screen: at most ``height`` lines of exactly ``width`` characters; the first is the title.

    Args:
        unicode: False draws with ASCII alone.
    """
    # Above and below the picture: (importance, line). When the window is low, the least important lines go.
    above = [(9, _title(scene, width, unicode)), (1, ''), (8, _headline(scene, width)), (0, '')]
    below = [
        (6, _tilt(scene, width)), (2, ''),
        (7, _push(scene, width, unicode)),
        *_moments(scene, width, unicode),
        (2, ''),
        (3, _share(scene, width, unicode)),
        (3, _returns(scene, width, unicode)),
        (4, _verdict(scene, width)),
        (7, _message(scene)), (8, _help(scene, width, unicode))]
    if not _message(scene):
        below[-2] = (1, '')
    for importance in range(9):
        if height - len(above) - len(below) >= min(_MIN_PICTURE, height // 3):
            break
        above = [line for line in above if line[0] != importance]
        below = [line for line in below if line[0] != importance]
    picture = draw(scene, width, max(height - len(above) - len(below), 0), unicode)
    lines = [text for _, text in above] + picture + [text for _, text in below]
    return [_harmless(line)[:width].ljust(width) for line in lines[:height]]


def _harmless(line: str) -> str:
    """A line without control characters: names of sources and messages come from whoever is on the graph."""
    return line if line.isprintable() else ''.join(c if c.isprintable() else '?' for c in line)


def _fitting(width: int, *texts: str) -> str:
    """The first text that fits, from the longest to the shortest."""
    return next((text for text in texts if len(text) <= width), texts[-1])


def _title(scene: Scene, width: int, unicode: bool) -> str:
    episode = '' if scene.episode is None else f'   episode {scene.episode}'
    time_left = scene.time_left if scene.phase in ('teach', 'test') else None
    left = '' if time_left is None else f'   time left {time_left:4.1f} s'
    what = f': {scene.task.name}' if scene.from_above else ' to balance the ball'
    bar = '' if time_left is None else f' {_time_bar(scene, time_left, unicode)}'
    return _fitting(width, f' Teach the robot{what}' + episode + left + bar, f' Teach the robot{what}' + episode + left,
                    (episode + left + bar)[2:], (episode + left)[2:])


def _time_bar(scene: Scene, left: float, unicode: bool) -> str:
    full = round(min(max(left / scene.episode_seconds, 0.0), 1.0) * _TIME_CELLS)
    done, rest = ('█', '░') if unicode else ('#', '.')
    return done * full + rest * (_TIME_CELLS - full)


def _headline(scene: Scene, width: int) -> str:
    if scene.paused:
        word, text = 'PAUSED', 'Everything stands still. Press p to go on.'
    elif scene.waiting:
        word, text = 'WAITING', scene.waiting.partition('\n')[0]
    elif scene.simulator_silent_for is not None and (
            scene.phase in ('practice', 'teach', 'test') or (scene.phase is None and not scene.in_session)):
        word = 'WAIT' if scene.in_session else 'WAITING FOR THE SIMULATOR'
        text = _silence(scene, scene.simulator_silent_for)
    else:
        title, text = _lesson(scene)
        word = title.upper()
    shorter = re.sub(r'[;,] [^.]*\.', '.', text)  # every sentence without its second half
    return _fitting(width, *(f' [ {word} ]  {said}' for said in (
        text, shorter, text.partition(':')[0].partition('. ')[0])))


def _silence(scene: Scene, seconds: float) -> str:
    """What is said of a robot of which nothing has been heard for some seconds."""
    if not scene.in_session:
        return 'No /joint_states' + (' yet.' if scene.pitch is None else f' for {seconds:.0f} s.')
    return STUCK.format(seconds=f'{seconds:.0f}') if seconds > STUCK_SECONDS else STANDS_STILL


def _lesson(scene: Scene) -> Words:
    """Title and words for the phase; between episodes how the last one ended, and when the next begins."""
    if scene.phase is None:
        return STARTING if scene.in_session else NO_LESSON
    title, text = words_for(scene.task).get(scene.phase, Words(scene.phase, ''))
    if scene.phase in ('learn', 'wait', 'done'):
        outcome = '' if scene.outcome is None or scene.feedback == 'none' else scene.outcome.words
        soon = '' if scene.next_in is None or scene.next_in <= 0.0 else f'Next in {math.ceil(scene.next_in)}.'
        text = ' '.join(filter(None, (outcome, soon))) or text
    elif scene.phase == 'practice':
        text = practice_words(scene.rests_left)
    elif scene.ending:
        text = 'The teaching ends with this episode. q: go on teaching.'
    return Words(title, text)


def _message(scene: Scene) -> str:
    """The latest notice to the person, or why the session waits."""
    return scene.message or scene.waiting.partition('\n')[2]


def _tilt(scene: Scene, width: int) -> str:
    if scene.pitch is None:
        return ''
    if scene.from_above:
        return _off_the_goal(scene, width)
    degrees = math.degrees(scene.pitch)
    side = '' if abs(degrees) < 0.05 else 'left' if degrees > 0 else 'right'
    tilt = f' tilt {abs(degrees):.1f} deg'
    long = f'{tilt}{side and f", {side} side down"} (drawn {STEEPER} x)'
    if scene.has_fallen:
        where = 'THE BALL HAS FALLEN'
    elif scene.ball_along is None:
        where = ''
    else:
        cm = 100.0 * scene.ball_along
        where = 'ball in the middle' if abs(cm) < 0.5 else (
            f'ball {abs(cm):.1f} cm {"left" if cm > 0 else "right"} of the middle')
    return _fitting(width, f'{long}   {where}', f'{tilt} {side}   {where.partition(" of ")[0]}')


def _off_the_goal(scene: Scene, width: int) -> str:
    tilt = '' if scene.tilt is None else f' tilt {math.degrees(scene.tilt):.1f} deg'
    if scene.has_fallen:
        return f'{tilt}   THE BALL HAS FALLEN'
    if scene.ball_on_tray is None:
        return tilt
    off = 100.0 * math.dist(scene.ball_on_tray[:2].tolist(), scene.tray.goal)
    where = 'ball at the goal' if off < 100.0 * scene.tray.goal_radius else f'ball {off:.1f} cm from the goal'
    return _fitting(width, f'{tilt}   {where}   (seen from above)', f'{tilt}   {where}')


def _push(scene: Scene, width: int, unicode: bool) -> str:
    """The notches of the person's push, and that it stays."""
    if scene.phase not in (None, *COUNT_IN) or scene.paused:
        return ' your keys do not count now'
    steps = max(round(scene.moment_limit / scene.keystroke), 1) if scene.keystroke > 0 else 1
    if steps > 8 or scene.from_above:
        pushed = any(scene.human)
        return _fitting(width, f' push      {"it stays until you press space" if pushed else "none"}', '')
    notches = round(scene.human[0] / scene.keystroke) if scene.keystroke > 0 else 0
    full, empty = ('■', '·') if unicode else ('#', '.')
    left, right = max(notches, 0), max(-notches, 0)
    drawn = f'{empty * (steps - left)}{full * left}|{full * right}{empty * (steps - right)}'
    side = 'left' if notches > 0 else 'right'
    words = f'{abs(notches)} to the {side}: it stays until you press space' if notches else 'none'
    return _fitting(width, f' push     {drawn} {words}', f' push     {drawn}')


def _moments(scene: Scene, width: int, unicode: bool) -> list[tuple[int, str]]:
    """Lines for the moments of human, robot and both, with their importance."""
    if scene.feedback != 'full':
        return []
    human, agent, applied = (scene.human, None, None) if scene.parts is None else scene.parts
    sources = ((7, scene.hand, 'M_yh', human), (4, 'robot', 'M_yai', agent), (5, 'together', 'M_y', applied))
    if not scene.from_above:
        return [(importance, _bar(who, symbol, None if moment is None else moment[0], scene, width, unicode))
                for importance, who, symbol, moment in sources]
    names = [f'M_{AXIS_NAMES[row][-1]}' for row in scene.task.axes]
    return [(importance, f' {who[:8]:8} ' + '   '.join(
        f'{name} {"   --" if moment is None else format(moment[axis] + 0.0, "+5.1f")}'
        for axis, name in enumerate(names)) + ' N m') for importance, who, _, moment in sources]


def _bar(who: str, symbol: str, moment: float | None, scene: Scene, width: int, unicode: bool) -> str:
    """A moment as a bar from the middle: to the left when it tips the tray to the left."""
    label = f' {who[:8]:8} {symbol:5} '
    half = max(width // 2 - len(label), 4)
    axis = '│' if unicode else '|'
    if moment is None:
        return f'{label}{"":{half}}{axis}{"":{half}}    -- N m'
    cells = min(abs(moment) / (2.0 * scene.moment_limit), 1.0) * half
    half_cell = ('▌' if moment < 0 else '▐') * (cells % 1.0 >= 0.5)
    bar = '█' * int(cells) + half_cell if unicode else '#' * round(cells)
    left, right = (bar[::-1], '') if moment > 0 else ('', bar)
    return f'{label}{left:>{half}}{axis}{right:<{half}}{moment + 0.0:+6.1f} N m'


def _share(scene: Scene, width: int, unicode: bool) -> str:
    if scene.human_share is None or scene.feedback != 'full':
        return ''
    cells = max(min(width // 2, 40), 4)
    share = min(max(scene.human_share, 0.0), 1.0)
    full = round(share * cells)
    done, left = ('█', '░') if unicode else ('#', '.')
    owner = 'your share' if scene.hand == 'you' else 'human share'
    return f' {owner:14} {done * full}{left * (cells - full)} {100 * share:3.0f} %'


def _returns(scene: Scene, width: int, unicode: bool) -> str:
    text = ''
    if scene.feedback != 'full':
        return text
    if returns := scene.counted_returns:
        sparks = _SPARKS[unicode]
        shown = returns[-max(min(width - 46, 40), 8):]
        low, high = min(shown), max(shown)
        span = (high - low) or 1.0
        levels = ''.join(sparks[round((value - low) / span * (len(sparks) - 1))] for value in shown)
        text = f' {"score":14} {levels}  last {shown[-1]:.0f}, best {max(returns):.0f}'
    if scene.success is not None and not scene.in_session:  # a session's own test, of more episodes, is told at its end
        text += f'   last test {100 * scene.success:.0f} %'
    return text


def _verdict(scene: Scene, width: int) -> str:
    """What the person may say of the last episode, or has said."""
    if scene.ended is None or not scene.offers_verdicts:
        return ''
    phase, number = scene.ended
    what = f' {"test" if phase == "test" else "episode"} {number}'
    keys = [f'{key}: {word}' for key, word, verdict in (
        ('g', 'good', Verdict.SUCCESS), ('b', 'bad', Verdict.FAILURE), ('x', 'discard', Verdict.DISCARD))
        if not (phase == 'test' and verdict is Verdict.DISCARD)]
    said = {Verdict.SUCCESS: 'good', Verdict.FAILURE: 'bad', Verdict.DISCARD: 'discarded'}.get(scene.verdict)
    if said is None:
        return _fitting(width, f'{what}   {"   ".join(keys)}', f'{what}: g b x')
    return _fitting(width, f'{what}: {said}   {"   ".join(keys)}   again: take back', f'{what}: {said}')


def _help(scene: Scene, width: int, unicode: bool) -> str:
    left, right = _ARROWS[unicode]
    keys = ('← ↑ ↓ → or a w s d' if unicode else 'arrows or a w s d') if scene.from_above else f'{left} {right} or a d'
    short = keys.partition(' or ')[0]
    end = 'q: go on teaching' if scene.ending else 'q: done teaching'
    if scene.phase == 'practice':
        end = 'Enter: not yet' if scene.rests_left else 'Enter: start teaching'
    word = end.replace(': ', ' ')
    return _fitting(
        width,
        f' {keys}: a press adds a notch of push, which stays   space: no push   {end}   p: pause   Ctrl-C: stop',
        f' {short}: push, a notch a press   space: no push   {end}   p: pause   ^C: stop',
        f' {short} push  space no push  {word}  p pause  ^C stop',
        f' {short} push  space no push  {word}  p  ^C',
        f' {short}  space no push  {word.partition(" ")[0]}  p  ^C',
        f' {short} space q p ^C')
