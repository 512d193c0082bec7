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

"""Reading a bag into arrays."""

import numpy as np
import pytest
import yaml
from shared_control import contract
from shared_control.keys import Key
from shared_control.robot.spec_file import panda
from shared_control_records.bag import fast_decode as bulk
from shared_control_records.bag.ball_tracks import broken_off, episode_tracks
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.presses import presses_that_count
from shared_control_records.bag.reader import BagReadError, read_bag
from shared_control_records.bag.ticks import digests
from shared_control_records.bag.timing import simulator_runs, timing_of
from shared_control_records.export.frames import episode_frames
from shared_control_testing import sessions as made


@pytest.fixture
def recording():
    return made.record([made.lesson(50, seed=1), made.lesson(50, seed=2)])


def test_every_message_comes_back(recording, tmp_path):
    bag = read_bag(recording.write(tmp_path / 'bag'), every_tick=True)
    states = recording.of(contract.JOINT_STATES)
    joints = bag.joint_states
    assert bag.counts[contract.JOINT_STATES.full_name] == len(joints.stamp_ns) == 2000
    assert bag.counts[contract.DISTURBANCE.full_name] == 0
    assert not bag.unusable
    np.testing.assert_array_equal(np.diff(joints.stamp_ns), 1_000_000)
    assert joints.stamp_ns[0] == made.START_NS
    np.testing.assert_array_equal(joints.q, [state.position for state in states])
    np.testing.assert_array_equal(joints.qd, [state.velocity for state in states])
    np.testing.assert_array_equal(joints.effort, [state.effort for state in states])
    np.testing.assert_array_equal(bag.ticks.stamp_ns, joints.stamp_ns)
    np.testing.assert_array_equal(bag.ticks.at_rest, (joints.qd == 0.0).all(axis=1))
    np.testing.assert_array_equal(bag.ticks.effort, digests(joints.effort))
    np.testing.assert_array_equal(
        bag.commands.torque, digests(np.array([sent.data for sent in recording.of(contract.EFFORT_COMMANDS)])))
    np.testing.assert_array_equal(bag.agent.moment[:, 0], [
        w.wrench.torque.y for w in recording.of(contract.AGENT_WRENCH)])
    balls = recording.of(contract.BALL)
    np.testing.assert_array_equal(bag.ball.position[:, 0], [ball.pose.pose.position.x for ball in balls])
    np.testing.assert_array_equal(bag.training[contract.EPISODE].values, [1, 2])
    np.testing.assert_array_equal(bag.training[contract.PHASE].values, ['teach', 'teach'])
    assert bag.statuses['panda_sim_node'][-1].number('ticks') == 2000
    assert bag.statuses['panda_sim_node'][-1].number('nothing') is None


def test_joint_states_of_every_10_ms_are_kept_unless_all_are_asked_for(recording, tmp_path, monkeypatch):
    path = recording.write(tmp_path / 'bag')
    whole = read_bag(path, every_tick=True)
    for block in (7, 20_000):
        monkeypatch.setattr(bulk, 'BLOCK', block)
        thinned = read_bag(path)
        for name in ('received_ns', 'stamp_ns', 'q', 'qd', 'effort'):
            np.testing.assert_array_equal(
                getattr(thinned.joint_states, name), getattr(whole.joint_states, name)[::10])
        np.testing.assert_array_equal(thinned.ticks.effort, whole.ticks.effort)
        assert check_bag(thinned) == check_bag(whole) == []
    np.testing.assert_array_equal(thinned.joint_states.stamp_ns, thinned.ball.stamp_ns, 'those of the ball')
    for one, other in zip(episode_tracks(thinned), episode_tracks(whole), strict=True):
        np.testing.assert_array_equal(one.position_error, other.position_error)


def test_digests_tell_torques_apart():
    random = np.random.default_rng(0)
    rows = random.normal(0.0, 20.0, (20_000, 7))
    rows[1:] = np.where(random.random((19_999, 7)) < 0.5, rows[1:], rows[:-1])  # many differ in a few joints only
    found = digests(rows)
    assert len(np.unique(found)) == len(np.unique(rows, axis=0))
    np.testing.assert_array_equal(digests(rows[::-1]), found[::-1])
    assert digests(np.array([[0.0, 1.0]]))[0] == digests(np.array([[-0.0, 1.0]]))[0]
    assert digests(np.array([[1.0, 2.0]]))[0] != digests(np.array([[2.0, 1.0]]))[0]
    assert digests(np.array([[1.0, 1.0]]))[0] != digests(np.array([[2.0, 2.0]]))[0]


def test_a_simulator_is_known_by_what_it_reports(tmp_path):
    recording = made.Recording()
    for second, node, ticks in ((1, 'robot1/a_simulator', 900), (2, 'robot1/a_simulator', 1900), (3, 'another', 700)):
        at = made.START_NS + second * 1_000_000_000
        recording.add(contract.DIAGNOSTICS, at, made.simulator_status(at, ticks, node))
        recording.add(contract.DIAGNOSTICS, at + 1, made.status(at, 'mock_panda_node', ticks=5 * ticks))
    runs = simulator_runs(read_bag(recording.write(tmp_path / 'bag')))
    assert [run.number('ticks') for run in runs] == [1900, 700]


@pytest.mark.parametrize('figures', [{'running_seconds': 'inf'}, {'tick_p50_ms': 'nan'}, {'late_ticks': 'many'},
                                     {'running_seconds': '0.0'}])
def test_figures_that_are_none_are_not_known(tmp_path, figures):
    """No NaN gets into a report's JSON, which no other reader takes."""
    of_one = {'ticks': 1000, 'tick_p50_ms': '0.61', 'tick_p99_ms': '0.93', 'late_ticks': '10',
              'running_seconds': '1.001', 'simulated_seconds': '1.0'}
    for name, reported, known in (('good', of_one, True), ('bad', of_one | figures, False)):
        recording = made.Recording()
        recording.add(contract.DIAGNOSTICS, made.START_NS, made.status(made.START_NS, 'panda_sim_node', **reported))
        assert (timing_of(read_bag(recording.write(tmp_path / name))) is not None) is known


def test_a_bag_of_several_blocks_with_odd_messages(recording, tmp_path, monkeypatch):
    """The fast way of decoding gives what the ordinary one gives, whatever comes between."""
    monkeypatch.setattr(bulk, 'BLOCK', 300)
    states = recording.of(contract.JOINT_STATES)
    states[0].header.frame_id = 'a_longer_name_than_the_others'
    states[700].header.frame_id = 'as_long_as1'
    states[701].name = states[701].name[:3]
    states[702].name = list(reversed(states[702].name))
    recording.of(contract.EFFORT_COMMANDS)[5].data = np.zeros(2)
    bag = read_bag(recording.write(tmp_path / 'bag'), every_tick=True)
    assert bag.unusable == {'/joint_states': 2, '/effort_controller/commands': 1}
    usable = [state for index, state in enumerate(states) if index not in (701, 702)]
    np.testing.assert_array_equal(bag.joint_states.effort, [state.effort for state in usable])
    assert bag.commands.torque.shape == (1999,)


def test_commands_are_decoded_a_block_at_a_time(recording, tmp_path, monkeypatch):
    """Though each names the tick that it answers."""
    alone = []
    one = bulk.BulkTopic._decode_one
    monkeypatch.setattr(bulk.BulkTopic, '_decode_one', lambda *args: alone.append(args) or one(*args))
    bag = read_bag(recording.write(tmp_path / 'bag'))
    assert len(bag.commands.torque) == 2000
    assert not alone


def test_garbled_messages_are_unusable_and_the_others_count(recording, tmp_path):
    whole = read_bag(recording.write(tmp_path / 'whole'))
    for topic in contract.BAG_TOPICS:
        recording.add(topic, made.START_NS + 1000, b'\x00\x01\x00\x00\xff')
    bag = read_bag(recording.write(tmp_path / 'bag'))
    assert bag.counts == {topic: count + 1 for topic, count in whole.counts.items()}
    not_decoded = (contract.CLOCK, contract.DISTURBANCE, contract.EMERGENCY_STOP, contract.HUMAN_VERDICT, contract.JOY)
    assert bag.unusable == {topic.full_name: 1 for topic in contract.BAG_TOPICS if topic not in not_decoded}
    assert len(bag.joint_states.stamp_ns) == len(whole.joint_states.stamp_ns)
    assert len(bag.ball.stamp_ns) == len(whole.ball.stamp_ns) and bag.presses == whole.presses


def test_what_was_in_the_hand_is_known(tmp_path):
    recording = made.record([made.lesson(5)])
    for index, (source, buttons, axes) in enumerate((
            ('joy', (0, 0, 0), (0.05, -0.02)), ('page', (0, 0, 0), ()), ('page', (0, 1, 0), ()),
            ('joy', (0, 0, 0), (0.0, -0.8)), ('bad', (0, 0, 0), (float('nan'),)))):
        recording.add(contract.KEYS, made.START_NS + made.MS + index, made.keys(made.START_NS, source, buttons, axes))
    bag = read_bag(recording.write(tmp_path / 'bag'))
    assert bag.devices == ['keys (tutor)', 'keys (page)', 'stick (joy)'], 'a stick that trembles is not used'
    assert bag.unusable == {'/human/keys': 1}


def test_presses_are_rising_edges_of_each_source(tmp_path):
    recording = made.Recording()
    for index, (source, buttons) in enumerate((
            ('tutor', (0, 0, 0)), ('tutor', (1, 0, 0)), ('page', (1, 0, 0)), ('tutor', (1, 0, 0)),
            ('page', ()), ('page', (1, 0, 0)),
            ('tutor', (0, 0, 1)), ('tutor', (0, 0, 1)), ('tutor', (1,)), ('tutor', (1,)), ('tutor', (1, 0, 1)))):
        recording.add(contract.KEYS, made.START_NS + index, made.keys(made.START_NS, source, buttons))
    bag = read_bag(recording.write(tmp_path / 'bag'))
    assert [(press.source, press.key) for press in bag.presses] == [
        ('tutor', Key.LEFT), ('page', Key.LEFT), ('page', Key.LEFT), ('tutor', Key.SPACE), ('tutor', Key.LEFT)]
    assert bag.unusable == {'/human/keys': 2}


def test_presses_count_in_practice_and_teaching_unless_it_is_paused(tmp_path):
    recording = made.Recording()

    def add(ms, topic, content):
        recording.add(topic, made.START_NS + ms * made.MS, content)
    for ms, phase in ((10, 'wait'), (20, 'practice'), (30, 'wait'), (40, 'teach'), (80, 'learn'), (90, 'test')):
        add(ms, contract.PHASE, made.message(contract.PHASE.type, data=phase))
    for ms, paused in ((1, False), (50, True), (60, False)):
        add(ms, contract.DIAGNOSTICS, made.status(made.START_NS, 'simulator', paused=paused))
    for ms in range(5, 100, 10):
        add(ms, contract.KEYS, made.keys(made.START_NS, 'page', (1, 0, 0)))
        add(ms + 1, contract.KEYS, made.keys(made.START_NS, 'page', (0, 0, 0)))
    bag = read_bag(recording.write(tmp_path / 'bag'))
    counted = [(press.received_ns - made.START_NS) // made.MS for press in presses_that_count(bag)]
    assert counted == [5, 25, 45, 65, 75], 'also before anybody gives a lesson'
    assert len(bag.presses) == 10


def test_an_empty_bag(tmp_path):
    bag = read_bag(made.Recording().write(tmp_path / 'bag'))
    assert bag.joint_states.q.shape == (0, panda().dof)
    assert bag.applied.moment.shape == (0, 1)
    assert not bag.presses
    assert episode_tracks(bag) == []


def test_bags_that_cannot_be_read(recording, tmp_path):
    with pytest.raises(BagReadError, match=r'there is no bag .*nowhere'):
        read_bag(tmp_path / 'nowhere')
    (tmp_path / 'notes.txt').write_text('of yesterday')
    for other in (tmp_path / 'notes.txt', tmp_path):
        with pytest.raises(BagReadError, match='is no bag'):
            read_bag(other)
    path = recording.write(tmp_path / 'bag')
    metadata = (path / 'metadata.yaml').read_bytes()
    (path / 'metadata.yaml').unlink()
    with pytest.raises(BagReadError, match='not finished'):
        read_bag(path)
    (path / 'metadata.yaml').write_bytes(metadata)
    file = next(path.glob('*.mcap'))
    file.write_bytes(file.read_bytes()[:-1000])
    with pytest.raises(BagReadError, match=str(path)):
        read_bag(path)


def test_tracks_of_the_finished_episodes(tmp_path):
    lessons = [made.lesson(50, seed=seed) for seed in range(3)]
    recording = made.record(lessons)
    recording.drop(contract.EPISODE_RETURN, 1, 1)  # the second episode was broken off
    for tenth in range(30):
        at = made.START_NS + tenth * 100 * made.MS
        recording.add(contract.HUMAN_SHARE, at, made.message(contract.HUMAN_SHARE.type, data=0.5))
    bag = read_bag(recording.write(tmp_path / 'bag'))
    assert broken_off(bag) == [(2, pytest.approx(0.9, abs=0.02))]
    tracks = episode_tracks(bag)
    assert [(track.number, track.phase) for track in tracks] == [(1, 'teach'), (3, 'teach')]
    error = lessons[2].position_error  # one a period of the policy; the last sample, 10 ms later, too
    np.testing.assert_allclose(tracks[1].position_error, [*error, error[-1]], atol=1e-12)
    assert tracks[0].seconds[0] == 0.0
    assert tracks[0].seconds[-1] == pytest.approx(0.99)
    assert tracks[1].end_ns - tracks[1].start_ns == 990_000_000


def one_run(number, x, m_y, start_ns, received_ns):
    """An episode of 2 s with ball and agent at rest, recorded from ``received_ns`` on."""
    recording = made.record([made.Lesson(np.full(100, x), np.zeros(100), np.full(100, m_y))], start_ns)
    for topic, _, content in recording.messages:
        if topic == contract.EPISODE:
            content.data = number
    shift = received_ns - start_ns
    return [(topic, at + shift, content) for topic, at, content in recording.messages]


def test_runs_whose_stamps_overlap_are_not_mixed(tmp_path):
    """A simulator that ran ahead of the clock was started anew: its time is set back by 1.5 s."""
    ms = made.MS
    recording = made.Recording([
        *one_run(1, 0.10, 1.0, made.START_NS, made.START_NS),
        *one_run(2, -0.05, -1.0, made.START_NS + 500 * ms, made.START_NS + 3000 * ms)])
    bag = read_bag(recording.write(tmp_path / 'bag'))
    for frames, x, m_y in zip(episode_frames(bag), (0.10, -0.05), (1.0, -1.0), strict=True):
        assert len(frames) == 100
        np.testing.assert_allclose(frames.position_error, x, atol=1e-9)
        np.testing.assert_array_equal(frames.agent[1:, 0], m_y)


def test_the_time_of_the_recorder_runs_on_where_its_clock_was_set_back(tmp_path, recording):
    """Two files of one bag, the second of which was recorded an hour earlier by the clock."""
    hour = 3600 * 10**9
    recording.write(tmp_path / 'one')
    made.Recording([(topic, at - hour, content) for topic, at, content in recording.messages]).write(tmp_path / 'two')
    alone = read_bag(tmp_path / 'two')
    bag = read_bag(joined(tmp_path / 'one', tmp_path / 'two'))
    assert (np.diff(bag.joint_states.received_ns) >= 0).all()
    assert bag.end_ns - bag.start_ns < 60 * 10**9
    assert [track.number for track in episode_tracks(bag)] == 2 * [track.number for track in episode_tracks(alone)]


def joined(bag, other):
    """``bag`` with the file of another one behind its own."""
    behind, = other.glob('*.mcap')
    behind.rename(bag / 'behind.mcap')
    content = yaml.safe_load((bag / 'metadata.yaml').read_text())
    information = content['rosbag2_bagfile_information']
    information['relative_file_paths'].append('behind.mcap')
    information['files'].append({**information['files'][0], 'path': 'behind.mcap'})
    (bag / 'metadata.yaml').write_text(yaml.safe_dump(content))
    return bag
