"""The fault campaign: a short form of `make faults`, and that its checks find what they are for."""

import json

import pytest
from shared_control import contract
from shared_control_records.session.folder import SessionFolder
from shared_control_testing.faults import Campaign, Fault, draw
from shared_control_testing.faults.checks import violations
from shared_control_testing.faults.plan import SHARES
from shared_control_testing.sessions import lesson, record, write_episodes

FAULTS = [Fault(0, 'corrupt', 'human/target_wrench', 'teach', 0.1, 0.5, 3),
          Fault(1, 'stop', 'panda_sim_node', 'teach', 0.3, 0.5, 4),
          Fault(2, 'kill', 'ppo_agent_node', 'teach', 0.3, 0.0, 5),
          Fault(3, 'network', 'drop', 'teach', 0.1, 0.5, 6),
          Fault(4, 'clock', 'back', 'teach', 0.3, 1.0, 7)]


def test_faults_are_repeated_by_seed_and_number():
    assert draw(0, 300)[:50] == draw(0, 50) != draw(1, 50)
    assert {fault.kind for fault in draw(0, 300)} == set(SHARES)


def test_a_short_campaign_finds_nothing(tmp_path, domain_id):
    said = []
    outcomes = Campaign(FAULTS, tmp_path, domain_id, said.append).run()
    assert [outcome.fault for outcome in outcomes] == FAULTS
    assert not [outcome for outcome in outcomes if outcome.violations], '\n'.join(said)


@pytest.fixture
def session(tmp_path):
    """``session(recording)``: violations in the folder of a made-up session with this recording."""
    def check(recording):
        folder = SessionFolder.create(tmp_path / 'session')
        recording.write(folder.bag)
        write_episodes(folder.episodes, LESSONS)
        folder.summary.write_text(json.dumps({'episodes': 1}))
        folder.report.touch()
        return violations(folder.path, [], lost_rows=False)
    return check


LESSONS = [lesson()]


def test_a_session_without_a_fault_has_no_violation(session):
    assert session(record(LESSONS)) == []


def test_torques_beyond_limit_and_rate_are_found(session):
    recording = record(LESSONS)
    for number, tick in enumerate(recording.of(contract.JOINT_STATES)[500:520]):
        tick.velocity[:] = 0.01
        tick.effort[0] = 90.0 if number < 10 else 0.0
    found = session(recording)
    assert [line.split(' at ')[0] for line in found if line.startswith('torque')] == [
        'torque: beyond the limit', 'torque: beyond the rate']


def test_a_moment_that_nobody_asked_for_is_found(session):
    recording = record(LESSONS)
    for asked in recording.of(contract.HUMAN_WRENCH):
        asked.wrench.torque.y = 0.0
    assert any(line.startswith('moment: the human moment') for line in session(recording))


def test_an_episode_that_is_not_in_the_bag_is_found(session):
    recording = record(LESSONS)
    recording.drop(contract.EPISODE_RETURN, 0, 1)
    assert any(line.startswith('table: the return') for line in session(recording))


def test_a_summary_that_is_no_json_is_found(session, tmp_path):
    found = session(record(LESSONS))
    assert not found
    (tmp_path / 'session' / 'summary.json').write_text('{"share": NaN}')
    assert any(line.startswith('report: summary.json') for line in violations(tmp_path / 'session', [], False))
