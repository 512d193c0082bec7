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

"""The screen as a function of the scene."""

from dataclasses import replace

import numpy as np
import pytest
from shared_control.tasks.balance import Balance
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import Plate
from shared_control.verdict import Verdict
from shared_control_ros.watching.outcome import Outcome, outcome_of
from shared_control_ros.watching.scene import Parts, Scene
from teleop_key_node.picture import draw
from teleop_key_node.screen import render

SCENE = Scene(
    pitch=0.04, ball_on_tray=np.array([0.10, 0.0, 0.021]), human=(5.0,), parts=Parts((5.0,), (-2.0,), (3.0,)),
    human_share=0.25,
    phase='teach', episode=3, time_left=9.4, returns=[-5000.0, -200.0, 40.0], success=0.95)


FELL = outcome_of(Balance(), 15.0, 7.0, (0.1, 0.0, 0.021))


def line_with(lines: list[str], text: str) -> str:
    found = [line for line in lines if text in line]
    assert len(found) == 1, '\n'.join(lines)
    return found[0]


def columns_of_dots(scene: Scene) -> list[list[int]]:
    """The columns of each line of the picture that are not blank."""
    return [[i for i, cell in enumerate(line) if cell != ' '] for line in draw(scene, 80, 10, True)]


def test_a_ball_at_plus_x_is_left_in_the_picture():
    without = columns_of_dots(replace(SCENE, pitch=0.0, ball_on_tray=None))
    for along, is_left in ((0.15, True), (-0.15, False)):
        ball = columns_of_dots(replace(SCENE, pitch=0.0, ball_on_tray=np.array([along, 0.0, 0.021])))
        added = [column for row, empty in zip(ball, without, strict=True) for column in set(row) - set(empty)]
        assert added
        assert all((column < 40) == is_left for column in added)
    assert 'ball 10.0 cm left of the middle' in '\n'.join(render(SCENE, 80, 24))


@pytest.mark.parametrize('text', ['\x1bc', '\x1b]0;a title\x07', 'two\nlines', '\x9b2J'])
@pytest.mark.parametrize('task', [Balance(), Plate()])
def test_what_others_say_commands_no_terminal(text, task):
    moments = (5.0,) * len(task.axes)
    scene = replace(SCENE, task=task, human=moments, parts=Parts(moments, moments, moments))
    for said in ({'hand': text}, {'message': text}, {'waiting': f'{text}\n{text}'}, {'phase': text}):
        lines = render(replace(scene, **said), 80, 24)
        assert len(lines) == 24 and all(len(line) == 80 and line.isprintable() for line in lines)


def test_a_positive_pitch_tips_the_left_side_down():
    for pitch, lower in ((0.04, 'left'), (-0.04, 'right')):
        rows = columns_of_dots(replace(SCENE, pitch=pitch, ball_on_tray=None))
        height = {side: max(row for row, columns in enumerate(rows) if columns and end(columns))
                  for side, end in (('left', lambda c: c[0] < 8), ('right', lambda c: c[-1] > 71))}
        assert max(height, key=lambda side: height[side]) == lower
        assert f'tilt 2.3 deg, {lower} side down (drawn 3 x)' in '\n'.join(render(replace(SCENE, pitch=pitch), 80, 24))


def test_bars_point_to_where_the_ball_is_pushed():
    lines = render(SCENE, 80, 24)
    human, agent, total = (line_with(lines, symbol) for symbol in ('M_yh', 'M_yai', 'M_y '))
    axis = human.index('│')
    assert axis == 40 == agent.index('│') == total.index('│')
    assert human[axis - 1] == '█'
    assert human[axis + 1] == ' '
    assert '+5.0 N m' in human
    assert agent[axis + 1] == '█'
    assert agent[axis - 1] == ' '
    assert '-2.0 N m' in agent
    assert human.count('█') > total.count('█') > agent.count('█')
    assert '-- N m' in line_with(render(replace(SCENE, parts=None), 80, 24), 'M_yai')


def test_bars_keep_to_their_place_beyond_the_scale():
    lines = render(replace(SCENE, parts=Parts((5.0,), (-110.0,), (-105.0,))), 80, 24)
    assert '-105.0 N m' in line_with(lines, 'M_y ')
    assert len(line_with(lines, 'M_y ')) == 80


@pytest.mark.parametrize(('changes', 'said'), [
    ({}, '[ TEACH ]'),
    ({}, 'Push when it errs; no push when it does well.'),
    ({}, '·■|·· 1 to the left: it stays until you press space'),
    ({'human': (-10.0,)}, '··|■■ 2 to the right'),
    ({'human': (0.0,)}, '··|·· none'),
    ({'phase': 'learn'}, '[ THE ROBOT LEARNS ]  Your keys do not count now.'),
    ({'phase': 'learn'}, ' your keys do not count now '),
    ({'phase': 'learn', 'outcome': FELL, 'next_in': 1.2}, 'The ball fell after 8 s. Next in 2.'),
    ({'phase': 'learn', 'outcome': FELL, 'next_in': 0.0}, 'The ball fell after 8 s.  '),
    ({'phase': 'test'}, '[ THE ROBOT ALONE ]  Hands off'),
    ({'phase': 'practice'}, '[ PRACTICE ]  You alone move the tray'),
    ({'phase': 'practice'}, 'Enter start teaching'),
    ({'ending': True}, 'The teaching ends with this episode. q: go on teaching.'),
    ({'ending': True}, 'space no push  q go on teaching  p'),
    ({'phase': 'wait'}, '[ GET READY ]'),
    ({'phase': 'done'}, '[ FINISHED ]'),
    ({'phase': 'dance'}, '[ DANCE ]'),
    ({'phase': None}, '[ NO LESSON ]'),
    ({'phase': None, 'in_session': True}, '[ STARTING ]'),
    ({'paused': True, 'simulator_silent_for': 9.0}, 'Press p to go on'),
    ({'simulator_silent_for': 3.2}, '[ WAITING FOR THE SIMULATOR ]  No /joint_states for 3 s.'),
    ({'simulator_silent_for': 3.2, 'in_session': True},
     '[ WAIT ]  The robot has stopped answering (3 s). Please tell the experimenter.'),
    ({'simulator_silent_for': 2.0, 'in_session': True}, '[ WAIT ]  The robot stands still.'),
    ({'simulator_silent_for': 9.0, 'in_session': True, 'phase': None}, '[ STARTING ]'),
    ({'simulator_silent_for': 9.0, 'phase': None, 'pitch': None}, 'No /joint_states yet.'),
    ({'simulator_silent_for': 3.2, 'phase': 'learn'}, '[ THE ROBOT LEARNS ]'),
    ({'waiting': 'for a tick since 14:00 (7 s)\nsimulator: no torque'}, '[ WAITING ]  for a tick since 14:00 (7 s)'),
    ({'waiting': 'for a tick since 14:00 (7 s)\nsimulator: no torque'}, 'simulator: no torque'),
    ({'ball_on_tray': np.array([0.1, 0.0, -0.1])}, 'THE BALL HAS FALLEN'),
    ({'ball_on_tray': np.array([0.3, 0.0, 0.021])}, 'THE BALL HAS FALLEN'),
    ({'hand': 'tutor'}, 'human share'),
    ({}, 'your share     ██████████░'),
    ({}, '25 %'),
    ({}, '▁██  last 40, best 40   last test 95 %'),
    ({}, 'episode 3   time left  9.4 s ██████░░░░'),
    ({'phase': 'test', 'time_left': 15.0}, 'time left 15.0 s ██████████'),
    ({'phase': 'practice', 'rests_left': 2}, 'Alone, bring the ball to rest on the mark for 3 s, twice more.'),
    ({'phase': 'practice', 'rests_left': 1}, 'Enter not yet'),
    ({'message': ' hello'}, ' hello'),
    ({'ended': ('teach', 2)}, ' episode 2   g: good   b: bad   x: discard '),
    ({'ended': ('teach', 2), 'verdict': Verdict.SUCCESS},
     ' episode 2: good   g: good   b: bad   x: discard   again: take back'),
    ({'ended': ('test', 1)}, ' test 1   g: good   b: bad  '),
    ({'discarded': {2}}, 'last -200, best -200'),
    ({'discarded': {1}}, 'last 40, best 40'),
])
def test_what_is_said(changes, said):
    assert said in '\n'.join(render(replace(SCENE, **changes), 80, 24))


@pytest.mark.parametrize(('feedback', 'shown', 'hidden'), [
    ('full', ('M_yai', 'your share', 'score', 'The ball fell'), ()),
    ('ball', ('The ball fell', 'push'), ('M_yai', 'your share', 'score')),
    ('none', ('push',), ('M_yai', 'your share', 'score', 'The ball fell'))])
def test_a_person_is_told_as_much_as_the_study_wants(feedback, shown, hidden):
    scene = replace(SCENE, feedback=feedback, ball_on_tray=np.zeros(3))
    text = '\n'.join(render(scene, 80, 24) + render(replace(scene, phase='learn', outcome=FELL), 80, 24))
    assert [word for word in shown if word not in text] == [] == [word for word in hidden if word in text]


def test_how_an_episode_ended_leaves_room_for_when_the_next_begins():
    off = Outcome(False, 'The ball was kept for 15 s; in the end 18 cm from the middle.')
    text = render(replace(SCENE, phase='learn', outcome=off, next_in=2.4), 80, 24)[2]
    assert text.rstrip() == ' [ THE ROBOT LEARNS ]  The ball was kept for 15 s. Next in 3.'


def test_who_is_not_to_judge_reads_nothing_of_it():
    scene = replace(SCENE, ended=('teach', 2), offers_verdicts=False)
    assert 'good' not in '\n'.join(render(scene, 80, 24))


@pytest.mark.parametrize('unicode', [True, False])
@pytest.mark.parametrize(('width', 'height'), [(80, 24), (60, 16), (40, 10), (20, 5), (1, 1), (200, 60), (79, 200)])
def test_any_window_is_filled_and_not_overrun(width, height, unicode):
    fallen = replace(SCENE, pitch=-0.5, ball_on_tray=np.array([0.1, 0.0, -3.0]), message='x' * 300)
    for scene in (SCENE, Scene(), fallen):
        lines = render(scene, width, height, unicode)
        assert len(lines) <= height
        assert all(len(line) == width for line in lines)
        assert unicode or '\n'.join(lines).isascii()


def test_a_small_window_keeps_what_matters():
    text = '\n'.join(render(SCENE, 60, 16))
    assert all(part in text for part in ('[ TEACH ]', 'M_yh', 'M_yai', 'tilt', 'space', 'episode 3'))
    text = '\n'.join(render(SCENE, 40, 10))
    assert all(part in text for part in ('[ TEACH ]', 'M_yh', 'space'))


FROM_ABOVE = replace(
    SCENE, task=Plate(), tilt=0.03, ball_on_tray=np.array([0.10, -0.05, 0.021]), human=(0.0, 0.0),
    parts=Parts((5.0, -5.0), (-3.0, 8.0), (2.0, 3.0)))


def dots_of(scene: Scene) -> set[tuple[int, int]]:
    """Rows and columns of the picture's characters that are not blank."""
    return {(row, column) for row, line in enumerate(draw(scene, 80, 16, True)) for column, cell in enumerate(line)
            if cell != ' '}


@pytest.mark.parametrize(('x', 'y', 'is_left', 'is_up'), [
    (0.1, -0.1, True, True), (-0.1, -0.1, False, True), (0.1, 0.1, True, False)])
def test_from_above_plus_x_is_left_and_minus_y_at_the_top(x, y, is_left, is_up):
    empty = dots_of(replace(FROM_ABOVE, ball_on_tray=None))
    ball = dots_of(replace(FROM_ABOVE, ball_on_tray=np.array([x, y, 0.021]))) - empty
    assert ball
    assert all((column < 40) == is_left and (row < 8) == is_up for row, column in ball)


def test_the_bar_is_drawn_from_the_wall_on_the_right():
    bar = dots_of(replace(FROM_ABOVE, task=Detour(), ball_on_tray=None)) - dots_of(
        replace(FROM_ABOVE, ball_on_tray=None))
    middle = {column for row, column in bar if row in (7, 8)}
    assert len(middle) > 10 and max(middle) > 45 and min(middle) > 33


@pytest.mark.parametrize(('moment', 'is_left', 'is_up'), [((10.0, 10.0), True, True), ((-10.0, -10.0), False, False)])
def test_an_arrow_points_to_where_the_moment_rolls_the_ball(moment, is_left, is_up):
    arrow = dots_of(replace(FROM_ABOVE, human=moment)) - dots_of(replace(FROM_ABOVE, human=(0.0, 0.0)))
    assert len(arrow) > 2
    assert all((column <= 10) == is_left and (row <= 7) == is_up for row, column in arrow)


@pytest.mark.parametrize(('changes', 'said'), [
    ({}, 'M_x  -3.0   M_y  +8.0 N m'), ({'parts': None}, 'M_x    --   M_y    -- N m'),
    ({}, 'ball 11.2 cm from the goal'),
    ({'ball_on_tray': np.array([0.01, 0.0, 0.021])}, 'ball at the goal'),
    ({'ball_on_tray': np.array([0.0, 0.2, 0.021])}, 'THE BALL HAS FALLEN'),
    ({'task': Detour()}, 'Bring the ball round the bar to the goal'), ({}, 'tilt 1.7 deg'), ({}, '← ↑ ↓ →'),
    ({}, 'Teach the robot: plate')])
def test_what_is_said_with_two_axes(changes, said):
    assert said in '\n'.join(render(replace(FROM_ABOVE, **changes), 100, 24))


@pytest.mark.parametrize(('width', 'height'), [(80, 24), (60, 16), (40, 10), (20, 5), (1, 1), (200, 60), (79, 200)])
def test_any_window_is_filled_from_above(width, height):
    lines = render(FROM_ABOVE, width, height, False)
    assert len(lines) <= height and all(len(line) == width for line in lines) and '\n'.join(lines).isascii()
