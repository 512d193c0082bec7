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

"""A recorded session, moment by moment."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest
from shared_control import contract
from shared_control_records.bag.reader import BagReadError, read_bag
from shared_control_testing.sessions import START_NS, lesson, message, record
from teach_page_node.recording import Recording
from teach_page_node.replay_desk import ReplayDesk


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Two episodes of 2 s."""
    return read_bag(record([lesson(seed=1), lesson(seed=2)]).write(tmp_path_factory.mktemp('bag') / 'bag'))


def test_a_picture_is_what_was_recorded(bag):
    picture = Recording(bag).picture(2.51)
    one = lesson(seed=2)
    assert picture.phase == 'teach'
    assert picture.episode == 2
    assert picture.parts[:2] == ((one.m_y_human[25],), pytest.approx((one.m_y_agent[25],)))
    assert -picture.ball_on_tray[0] == pytest.approx(one.position_error[25], abs=1e-3)
    assert picture.history.returns == [-100.0]
    assert picture.message()['q'] == [round(angle, 4) for angle in picture.q.tolist()]


@pytest.mark.parametrize(('last', 'words'), [(0.0, 'The ball was kept for 2 s'), (1.0, 'The ball fell after 1 s')])
def test_the_outcome_tells_the_length_of_the_episode(tmp_path, last, words):
    made = record([lesson(), lesson()])
    for topic in (contract.PHASE, contract.EPISODE):
        made.drop(topic, 1, 1)
    made.add(contract.PHASE, START_NS + 2_000_000_000, message(contract.PHASE.type, data='learn'))
    for seconds, left in ((0.001, 2.0), (0.1, 1.9), (1.9, last), (2.1, 2.9)):
        made.add(contract.TIME_LEFT, START_NS + round(seconds * 1e9), message(contract.TIME_LEFT.type, data=left))
    recording = Recording(read_bag(made.write(tmp_path / 'bag')))
    assert recording.picture(1.0).message()['episode_seconds'] == 2.0
    assert recording.picture(3.0).outcome.words.startswith(words)


def test_verdicts_are_at_the_marks_and_what_is_discarded_leaves_the_chart(tmp_path):
    recorded = record([lesson(seed=seed) for seed in (1, 2, 3)])
    for seconds, key, value in ((2.1, 'teach 1', ''), (2.5, 'teach 1', 'discard'), (4.1, 'teach 2', ''),
                                (4.5, 'teach 2', 'success')):
        recorded.add(contract.VERDICT, START_NS + round(seconds * 1e9),
                     message(contract.VERDICT.type, key=key, value=value))
    recording = Recording(read_bag(recorded.write(tmp_path / 'bag')))
    assert [mark[1:] for mark in recording.marks()] == [('1', 'discard'), ('2', 'success'), ('3', '')]
    returns = [recording.picture(seconds).history.message()['returns'] for seconds in (2.3, 2.7, 4.7)]
    assert returns == [[-100.0], [], [-100.0]]


@pytest.mark.parametrize('without', [(topic,) for topic in contract.TRAINING] + [contract.TRAINING])
def test_a_bag_without_a_lesson_or_without_an_episode_that_ended_can_be_seen(tmp_path, without):
    """Stopped in the practice or in the first episode; teleoperation alone; a topic that somebody left out."""
    made = record([lesson()])
    for topic in without:
        made.drop(topic, 0, len(made.of(topic)))
    bag = read_bag(made.write(tmp_path / 'bag', without=() if len(without) == 1 else without))
    desk = ReplayDesk(Recording(bag))
    desk.do('seek', 1.0)
    picture = desk.look()
    assert picture.message()['q'] and picture.trace
    assert picture.history.message()['returns'] == []
    Recording(bag).marks()


def test_moments_that_are_no_numbers_are_told_as_none(tmp_path):
    """JSON cannot say them, and a browser drops the whole picture."""
    made = record([lesson()])
    for wrench in made.of(contract.HUMAN_APPLIED)[40:60]:
        wrench.wrench.torque.y = math.nan
    for wrench in made.of(contract.APPLIED_WRENCH)[40:60]:
        wrench.wrench.torque.y = math.inf
    desk = ReplayDesk(Recording(read_bag(made.write(tmp_path / 'bag'))))
    desk.do('seek', 1.5)
    message = desk.look().message()
    json.dumps(message, allow_nan=False)
    assert any(human is None and agent is not None for _, human, agent, _ in message['trace'])


def test_keys_are_lit_while_they_were_pressed(bag):
    recording = Recording(bag)
    assert recording.picture(0.41).keys == [1, 0, 0]
    assert recording.picture(0.58).keys == [0, 0, 0]
    assert recording.picture(0.41).hand == 'tutor'


def test_both_ends_can_be_seen(bag):
    recording = Recording(bag)
    assert recording.length == pytest.approx(4.0, abs=0.02)  # joint states are kept every 10 ms
    assert recording.picture(0.0).history.returns == []
    assert recording.picture(recording.length).episode == 2


def test_a_gap_between_two_runs_is_shortened(tmp_path):
    made = record([lesson(seed=1)])
    made.messages += record([lesson(seed=2)], start_ns=made.messages[-1][1] + 3_600_000_000_000).messages
    recording = Recording(read_bag(made.write(tmp_path / 'bag')))
    assert recording.length == pytest.approx(6.0, abs=0.03)
    assert recording.picture(3.0).parts is None, 'nobody spoke in the gap'
    assert recording.picture(5.0).parts is not None


def test_moments_shown_together_are_of_one_run_when_the_time_of_the_robot_was_set_back(tmp_path):
    made = record([lesson(150, seed=1)])
    later_ns = 4_000_000_000
    made.messages += [(topic, received_ns + later_ns, content)
                      for topic, received_ns, content in record([lesson(100, seed=2)]).messages]
    recording = Recording(read_bag(made.write(tmp_path / 'bag')))
    second = lesson(100, seed=2)
    shown = [(human[0] + agent[0], applied[0], human[0]) for human, agent, applied in filter(None, (
        recording.picture(seconds).parts for seconds in np.arange(0.05, recording.length, 0.05)))]
    assert len(shown) > 80
    assert all(sum_of_both == pytest.approx(applied) for sum_of_both, applied, _ in shown)
    assert shown[-1][2] == second.m_y_human[-1]
    rows = [row for row in recording.trace(recording.length, 1.5) if row[1] is not None]
    assert rows and all(human + agent == pytest.approx(applied, abs=1e-3) for _, human, agent, applied in rows)


def test_a_bag_without_a_ball_is_refused(tmp_path):
    path = record([lesson()]).write(tmp_path / 'bag', without=(contract.BALL,))
    with pytest.raises(BagReadError, match='nothing to see'):
        Recording(read_bag(path))


def test_the_player_seeks_holds_and_changes_speed(bag):
    desk = ReplayDesk(Recording(bag))
    desk.do('play', False)
    desk.do('seek', 3)
    desk.do('speed', 4)
    assert desk.look().replay == {'position': 3.0, 'length': pytest.approx(4.0, abs=0.01), 'speed': 4.0, 'plays': False}
    for too_far in (1e9, 10**400):
        desk.do('seek', 3)
        desk.do('seek', too_far)
        assert desk.look().replay['position'] == desk.look().replay['length']
    desk.do('play', True)
    assert desk.look().replay['position'] < 1.0, 'from the beginning'


@pytest.mark.parametrize(('command', 'value'), [
    ('seek', None), ('seek', float('nan')), ('speed', 3), ('speed', 'fast'), ('play', 1), ('stop', None)])
def test_what_a_player_cannot_do_is_named(bag, command, value):
    with pytest.raises(ValueError, match=command):
        ReplayDesk(Recording(bag)).do(command, value)


def test_a_replay_needs_no_ros():
    """As its help says: on a laptop with bags and no ROS."""
    program = """
import sys
for name in ('rclpy', 'sensor_msgs', 'geometry_msgs', 'std_msgs', 'nav_msgs', 'std_srvs', 'rcl_interfaces'):
    sys.modules[name] = None
import teach_page_node.recording, teach_page_node.replay, teach_page_node.replay_desk, teach_page_node.server
"""
    subprocess.run([sys.executable, '-c', program], check=True)
