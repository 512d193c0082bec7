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

"""The checks of a bag find what is wrong, and nothing else."""

import numpy as np
import pytest
from shared_control import contract
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.reader import read_bag
from shared_control_testing import sessions as made

MS = made.MS


@pytest.fixture
def recording():
    return made.record([made.lesson(60, seed=1), made.lesson(60, seed=2)])


def findings(recording, path, **parameters):
    return check_bag(read_bag(recording.write(path / 'bag')), **parameters)


def applied_at(recording, tick, topic=contract.APPLIED_WRENCH):
    """The applied wrench of a tick."""
    at = made.START_NS + tick * MS
    return next(sent for sent in recording.of(topic)
                if sent.header.stamp.sec * 1_000_000_000 + sent.header.stamp.nanosec == at)


def test_nothing_is_wrong_with_a_good_bag(recording, tmp_path):
    assert findings(recording, tmp_path) == []


def test_missing_and_silent_topics(recording, tmp_path):
    recording.messages = [entry for entry in recording.messages if entry[0] != contract.CLOCK]
    bag = read_bag(recording.write(tmp_path / 'bag', without=(contract.SUCCESS,)))
    assert check_bag(bag) == ['/clock has no messages', '/training/success was not recorded']
    assert check_bag(bag, expected=(contract.BALL.full_name, '/camera')) == ['/camera was not recorded']


def test_a_gap_in_the_joint_states(recording, tmp_path):
    recording.drop(contract.JOINT_STATES, 1000, 15)
    found = findings(recording, tmp_path)
    assert found[0] == '/joint_states: 1 gap, 15 ticks missing; the first after 0.999 s'
    assert found[1] == '/effort_controller/commands: 2400 commands for 2385 ticks of /joint_states'


def test_a_missing_command(recording, tmp_path):
    recording.drop(contract.EFFORT_COMMANDS, 1000, 3)
    assert findings(recording, tmp_path) == [
        '/effort_controller/commands: 2397 commands for 2400 ticks of /joint_states',
        '/effort_controller/commands: 3 ticks with a torque that was not commanded; the first after 1.001 s']


def test_states_that_the_recorder_hears_long_after_their_answers(recording, tmp_path):
    late_ns = made.START_NS + 150 * MS
    recording.messages = [(topic, max(at, late_ns) if topic == contract.JOINT_STATES else at, sent)
                          for topic, at, sent in recording.messages]
    assert findings(recording, tmp_path) == []


@pytest.mark.parametrize('topic', made.APPLIED)
def test_a_missing_applied_moment(recording, tmp_path, topic):
    recording.drop(topic, 100, 4)
    assert any(f'{topic.full_name}: 1 time nothing for more than 20 ticks' in finding
               for finding in findings(recording, tmp_path))


def test_a_repeated_tick_is_no_gap(recording, tmp_path):
    state = recording.of(contract.JOINT_STATES)[500]
    recording.add(contract.JOINT_STATES, made.START_NS + 500 * MS + 20, state)
    assert findings(recording, tmp_path) == []


def test_a_reset_between_two_policy_ticks_is_no_gap(recording, tmp_path):
    for topic in (contract.JOINT_STATES, contract.EFFORT_COMMANDS):
        recording.drop(topic, 1195, 5)  # the last of the first lesson
    assert findings(recording, tmp_path) == []


def test_a_restarted_simulator_is_no_gap_but_a_jump_is(recording, tmp_path):
    later = made.record([made.lesson(20, seed=3)], start_ns=made.START_NS + 9_000 * MS)
    both = made.Recording(recording.messages + later.messages)
    assert findings(both, tmp_path / 'restarted') == []
    both.messages = [entry for entry in both.messages if entry[0] != contract.DIAGNOSTICS]
    both.add(contract.DIAGNOSTICS, made.START_NS, made.simulator_status(made.START_NS, 1))
    assert any('1 gap' in finding for finding in findings(both, tmp_path / 'jumped'))


@pytest.mark.parametrize('error', [0.5, 1e-6])
def test_a_moment_that_nobody_asked_for(recording, tmp_path, error):
    applied_at(recording, 2000).wrench.torque.y += error
    found = findings(recording, tmp_path)
    assert len(found) == 1
    assert 'the sum is not that of its parts at 1 tick; the first after 2.0' in found[0]


@pytest.mark.parametrize('topic', [contract.HUMAN_APPLIED, contract.AGENT_APPLIED])
@pytest.mark.parametrize('error', [0.5, np.nan])
def test_a_part_that_is_not_in_the_sum(recording, tmp_path, topic, error):
    applied_at(recording, 2000, topic).wrench.torque.y += error
    assert any('at 1 tick' in finding for finding in findings(recording, tmp_path))


@pytest.mark.parametrize('topic', made.APPLIED)
def test_only_messages_of_one_stamp_are_compared(recording, tmp_path, topic):
    """A recorder that finds the topics one after the other misses some at the start."""
    recording.drop(topic, 0, 5)
    assert findings(recording, tmp_path) == []


def test_of_a_tick_that_was_answered_again_the_last_moments_count(recording, tmp_path):
    for topic in made.APPLIED:
        first = made.wrench(made.START_NS + 2000 * MS, 77.0)
        recording.add(topic, made.START_NS + 2000 * MS, first)
    assert findings(recording, tmp_path) == []


def test_the_limit_of_the_moment(tmp_path):
    loud = made.lesson(20)
    loud.m_y_agent[:] = 30.0
    recording = made.record([loud])
    assert findings(recording, tmp_path / 'as_it_was') == []
    assert findings(recording, tmp_path / 'other', moment_limit=25.0)


def test_what_a_source_asked_for_need_not_have_counted(tmp_path):
    """The human's messages stop at 1 s; the controller lets the moment fade, and its parts tell what counted."""
    steady = made.lesson(60)
    steady.m_y_human[:], steady.m_y_agent[:] = 5.0, 1.0
    recording = made.record([steady])
    recording.drop(contract.HUMAN_WRENCH, 50, 1000)
    last = made.START_NS + 980 * MS
    for total, human in zip(*map(recording.of, made.APPLIED[:2]), strict=True):
        age = (total.header.stamp.sec * 1_000_000_000 + total.header.stamp.nanosec - last) * 1e-9
        if age > 0.0:
            human.wrench.torque.y = 5.0 * np.clip(1.0 - (age - 0.1) / 0.1, 0.0, 1.0)
            total.wrench.torque.y = 1.0 + human.wrench.torque.y
    assert findings(recording, tmp_path / 'faded') == []


def test_a_wrench_of_another_frame_is_unusable(recording, tmp_path):
    at = made.START_NS + 1205 * MS
    recording.add(contract.HUMAN_WRENCH, at, made.wrench(at, 9.0, frame='world'))
    assert findings(recording, tmp_path) == ['/human/target_wrench: 1 unusable messages']
