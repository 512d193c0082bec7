"""The teaching screen as lines of text: a pure function of the scene and the size of the window."""

import math

from shared_control.wrench import AXIS_NAMES
from shared_control_ros.watching.scene import Scene

from .picture import STEEPER, draw, has_fallen

_PHASES = {
    'teach': 'Keep the ball in the middle: the robot learns from your keys.',
    'learn': 'The robot thinks the episode over. Keys rest; just a moment.',
    'test': 'The robot is on its own. Hands off: keys do nothing now.',
    'wait': 'The next episode is about to start.',
    'done': 'The lesson is over.',
}
_MIN_PICTURE = 5
"""Lines; less important lines go before the picture gets smaller, except in a tiny window."""
_SPARKS = {True: '▁▂▃▄▅▆▇█', False: '_.-:=+*#'}
_ARROWS = {True: ('←', '→'), False: ('<-', '->')}


def render(scene: Scene, width: int, height: int, unicode: bool = True) -> list[str]:
    """The screen: at most ``height`` lines of exactly ``width`` characters; the first is the title.

    Args:
        unicode: False draws with ASCII alone.
    """
    # Above and below the picture: (importance, line). When the window is low, the least important lines go.
    above = [(9, _title(scene, width)), (1, ''), (8, _headline(scene, width)), (0, '')]
    below = [
        (6, _tilt(scene, width)), (2, ''),
        *_moments(scene, width, unicode),
        (2, ''),
        (3, _share(scene, width, unicode)),
        (3, _returns(scene, width, unicode)),
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
    return [line[:width].ljust(width) for line in lines[:height]]


def _fitting(width: int, *texts: str) -> str:
    """The first text that fits, from the longest to the shortest."""
    return next((text for text in texts if len(text) <= width), texts[-1])


def _title(scene: Scene, width: int) -> str:
    episode = '' if scene.episode is None else f'   episode {scene.episode}'
    left = '' if scene.time_left is None else f'   time left {scene.time_left:4.1f} s'
    what = f': {scene.task.name}' if scene.from_above else ' to balance the ball'
    return _fitting(width, f' Teach the robot{what}' + episode + left, (episode + left)[2:])


def _headline(scene: Scene, width: int) -> str:
    if scene.paused:
        word, text = 'PAUSED', 'Everything stands still. Press p to go on.'
    elif scene.waiting:
        word, text = 'WAITING', scene.waiting.partition('\n')[0]
    elif scene.simulator_silent_for is not None and scene.phase in (None, 'teach', 'test'):
        word = 'WAITING FOR THE SIMULATOR'
        silent = scene.simulator_silent_for
        text = 'No /joint_states' + (f' for {silent:.0f} s.' if math.isfinite(silent) else ' yet.')
    elif scene.phase is None:
        word, text = 'FREE', 'No robot is being taught. Your keys tilt the tray: try them.'
    else:
        word, text = scene.phase.upper(), _PHASES.get(scene.phase, '')
        if scene.phase == 'teach' and scene.from_above:
            text = f'{scene.task.instruction.rstrip(".")}: the robot learns from your keys.'
    return _fitting(width, f' [ {word} ]  {text}', f' [ {word} ]  {text.partition(":")[0].partition(". ")[0]}')


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
    if has_fallen(scene):
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
    if has_fallen(scene):
        return f'{tilt}   THE BALL HAS FALLEN'
    if scene.ball_on_tray is None:
        return tilt
    off = 100.0 * math.dist(scene.ball_on_tray[:2].tolist(), scene.tray.goal)
    where = 'ball at the goal' if off < 100.0 * scene.tray.goal_radius else f'ball {off:.1f} cm from the goal'
    return _fitting(width, f'{tilt}   {where}   (seen from above)', f'{tilt}   {where}')


def _moments(scene: Scene, width: int, unicode: bool) -> list[tuple[int, str]]:
    """Lines for the moments of human, robot and both, with their importance."""
    sources = ((7, scene.hand, 'M_yh', scene.human), (4, 'robot', 'M_yai', scene.agent),
               (5, 'sum', 'M_y', scene.applied))
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
    if scene.human_share is None:
        return ''
    cells = max(min(width // 2, 40), 4)
    share = min(max(scene.human_share, 0.0), 1.0)
    full = round(share * cells)
    done, left = ('█', '░') if unicode else ('#', '.')
    owner = 'your share' if scene.hand == 'you' else 'human share'
    return f' {owner:14} {done * full}{left * (cells - full)} {100 * share:3.0f} %'


def _returns(scene: Scene, width: int, unicode: bool) -> str:
    text = ''
    if scene.returns:
        sparks = _SPARKS[unicode]
        shown = scene.returns[-max(min(width - 46, 40), 8):]
        low, high = min(shown), max(shown)
        span = (high - low) or 1.0
        levels = ''.join(sparks[round((value - low) / span * (len(sparks) - 1))] for value in shown)
        text = f' {"returns":14} {levels}  last {shown[-1]:.0f}, best {max(scene.returns):.0f}'
    if scene.success is not None:
        text += f'   last test {100 * scene.success:.0f} %'
    return text


def _help(scene: Scene, width: int, unicode: bool) -> str:
    left, right = _ARROWS[unicode]
    if scene.from_above:
        arrows = '← ↑ ↓ →' if unicode else 'arrows'
        return _fitting(
            width, f' {arrows} or a w s d: tip the tray   space: let go   q: it has learned   p: pause   ^C: quit',
            f' {arrows} tip   space let go   q learned   p pause   ^C quit', f' {arrows} space q p ^C')
    return _fitting(
        width,
        f' {left} a: left   d {right}: right   space: let go   q: it has learned   p: pause   Ctrl-C: quit',
        f' {left} a left   d {right} right   space let go   q it has learned   p pause   ^C quit',
        f' {left} a  d {right}  space let go  q learned  p pause  ^C quit',
        f' {left} {right} space q p ^C')
