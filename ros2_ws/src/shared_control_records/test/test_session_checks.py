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


def applied_at(recording, tick):
    """The applied wrench of a tick."""
    at = made.START_NS + tick * MS
    return next(sent for sent in recording.of(contract.APPLIED_WRENCH)
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


def test_a_missing_applied_moment(recording, tmp_path):
    recording.drop(contract.APPLIED_WRENCH, 100, 4)
    assert any('nothing for more than 20 ticks' in finding for finding in findings(recording, tmp_path))


def test_a_repeated_tick_is_no_gap(recording, tmp_path):
    state = recording.of(contract.JOINT_STATES)[500]
    recording.add(contract.JOINT_STATES, made.START_NS + 500 * MS + 20, state)
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
    assert 'M_y is not M_yai + M_yh at 1 tick; the first after 2.0' in found[0]


def test_a_message_taken_up_too_late(recording, tmp_path):
    """The agent's message of tick 2000 counts from 2003 on; here the one before it counts 140 ms longer."""
    before = applied_at(recording, 2000).wrench.torque.y
    for tick in (*range(2003, 2143, 20), *range(2010, 2150, 10)):
        applied_at(recording, tick).wrench.torque.y = before
    assert any('M_y is not' in finding for finding in findings(recording, tmp_path))


def test_no_source_may_go_back(recording, tmp_path):
    before = applied_at(recording, 2000).wrench.torque.y
    assert before != applied_at(recording, 2003).wrench.torque.y
    applied_at(recording, 2010).wrench.torque.y = before
    assert any('at 1 tick' in finding for finding in findings(recording, tmp_path))


def test_the_limit_of_the_moment(tmp_path):
    loud = made.lesson(20)
    loud.m_y_agent[:] = 30.0
    recording = made.record([loud])
    assert findings(recording, tmp_path / 'as_it_was') == []
    assert findings(recording, tmp_path / 'other', moment_limit=25.0)


def test_a_silent_source_fades(tmp_path):
    """The human's messages stop at 1 s; the moment fades from 0.1 to 0.2 s after the last one."""
    steady = made.lesson(60)
    steady.m_y_human[:], steady.m_y_agent[:] = 5.0, 1.0
    recording = made.record([steady])
    recording.drop(contract.HUMAN_WRENCH, 50, 1000)
    last = made.START_NS + 980 * MS
    for sent in recording.of(contract.APPLIED_WRENCH):
        age = (sent.header.stamp.sec * 1_000_000_000 + sent.header.stamp.nanosec - last) * 1e-9
        if age > 0.0:
            sent.wrench.torque.y = 1.0 + 5.0 * np.clip(1.0 - (age - 0.1) / 0.1, 0.0, 1.0)
    assert findings(recording, tmp_path / 'faded') == []
    for sent in recording.of(contract.APPLIED_WRENCH):
        sent.wrench.torque.y = 6.0 if sent.wrench.torque.y > 1.0 else sent.wrench.torque.y
    assert findings(recording, tmp_path / 'latched')


@pytest.mark.parametrize(('late_ms', 'is_explained'), [(180, True), (20, False)])
def test_a_source_that_comes_too_late_is_refused(tmp_path, late_ms, is_explained):
    """The human's messages from 1 s on are too old when they come; the moment fades as that of a silent source."""
    steady = made.lesson(60)
    steady.m_y_human[:], steady.m_y_agent[:] = 5.0, 1.0
    recording = made.record([steady])
    last = made.START_NS + 980 * MS
    recording.messages = [
        (topic, ns + late_ms * MS * (topic == contract.HUMAN_WRENCH and ns > last + 10 * MS), content)
        for topic, ns, content in recording.messages]
    for sent in recording.of(contract.APPLIED_WRENCH):
        age = (sent.header.stamp.sec * 1_000_000_000 + sent.header.stamp.nanosec - last) * 1e-9
        sent.wrench.torque.y = 1.0 + 5.0 * np.clip(1.0 - (age - 0.1) / 0.1, 0.0, 1.0)
    assert (findings(recording, tmp_path) == []) == is_explained


def test_messages_that_the_controller_drops(recording, tmp_path):
    for tick, fault in ((1105, made.wrench(made.START_NS + 1105 * MS, np.nan)),
                        (1205, made.wrench(made.START_NS + 1205 * MS, 9.0, frame='world')),
                        (1305, made.wrench(made.START_NS + 1005 * MS, 9.0)),
                        (1405, made.wrench(made.START_NS + 1705 * MS, 9.0))):
        recording.add(contract.HUMAN_WRENCH, made.START_NS + tick * MS, fault)
    assert findings(recording, tmp_path) == []


def test_a_controller_that_starts_anew(recording, tmp_path):
    """It has heard nobody yet, so its first moments are zero, and the agent is heard before the human."""
    wall_pause = 500 * MS
    cut = made.START_NS + 2010 * MS
    messages = [(topic, ns + wall_pause * (ns > cut), content) for topic, ns, content in recording.messages]
    for tick in (2010, 2020, 2023, 2030):
        applied_at(recording, tick).wrench.torque.y = 0.0
    assert findings(made.Recording(messages), tmp_path) == []
