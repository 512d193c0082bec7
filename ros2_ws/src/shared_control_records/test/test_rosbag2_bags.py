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

"""Bags that rosbag2's own tools wrote, as far as ``mcap`` and ``rosbags`` can stand in for them."""

import dataclasses
import json
from collections import Counter

import numpy as np
import pandas as pd
import pytest
from rosbags.rosbag2 import Reader
from shared_control import contract
from shared_control.cli import main
from shared_control_records.bag import annotate, recover
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.files import find_bag
from shared_control_records.bag.reader import BagReadError, read_bag, recorded_namespace
from shared_control_testing import rosbag2
from shared_control_testing import sessions as made

FORMS = {
    'converted': {},
    'split': {'files': 4},
    'compressed by file': {'compression': 'file'},
    'split and compressed by file': {'files': 3, 'compression': 'file'},
    'compressed by message': {'compression': 'message'},
    'without chunks': {'chunks': False},
    'recorded without QoS': {'qos': False},
    'namespaced': {'rename': lambda topic: topic if topic == '/clock' else f'/robot1{topic}'},
}


@pytest.fixture(scope='module')
def own(tmp_path_factory):
    return made.record([made.lesson(50), made.lesson(80, seed=1)]).write(tmp_path_factory.mktemp('made') / 'bag')


def equal(one, other):
    """Whether two bags have the same content, whatever their files are called."""
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
    elif dataclasses.is_dataclass(one):
        for field in dataclasses.fields(one):
            if field.name not in ('path', 'counts'):
                equal(getattr(one, field.name), getattr(other, field.name))
    elif isinstance(one, dict):
        assert one.keys() == other.keys()
        for key, value in one.items():
            equal(value, other[key])
    else:
        assert one == other


def run(monkeypatch, *arguments):
    monkeypatch.setattr('sys.argv', ['shared-control', *map(str, arguments)])
    return main()


@pytest.mark.parametrize('form', FORMS)
def test_a_bag_of_rosbag2_is_read_as_our_own(own, tmp_path, form):
    bag = rosbag2.convert(own, tmp_path / 'other', **FORMS[form])
    read, original = read_bag(bag), read_bag(own)
    equal(read, original)
    assert +Counter(read.counts) == +Counter(original.counts)
    assert check_bag(read, expected=()) == []


def test_a_reindexed_bag_is_read_and_recovered(own, tmp_path):
    bag = rosbag2.reindex(rosbag2.convert(own, tmp_path / 'other', files=2))
    equal(read_bag(bag), read_bag(own))
    before = (bag / 'metadata.yaml').read_text()
    assert recover(bag) == [] and (bag / 'metadata.yaml').read_text() == before


@pytest.mark.parametrize('chunks', [True, False])
def test_a_killed_recording_of_rosbag2_is_finished(own, tmp_path, chunks, monkeypatch, capsys):
    bag = rosbag2.convert(own, tmp_path / 'other', chunks=chunks)
    path, = bag.glob('*.mcap')
    path.write_bytes(path.read_bytes()[:path.stat().st_size * 2 // 3])
    for metadata in (True, False):  # `ros2 bag reindex` makes one for a torn file
        if not metadata:
            (bag / 'metadata.yaml').unlink()
        for command in (['report', bag], ['export', bag], ['export', path]):
            assert run(monkeypatch, *command) == 2
            assert f'`shared-control recover {bag}` finishes it' in capsys.readouterr().err
    assert run(monkeypatch, 'recover', bag) == 0
    assert 'messages kept' in capsys.readouterr().out
    read, original = read_bag(bag), read_bag(own)
    kept = len(read.joint_states.stamp_ns)
    assert 0.3 * len(original.joint_states.stamp_ns) < kept < len(original.joint_states.stamp_ns)
    np.testing.assert_array_equal(read.joint_states.q, original.joint_states.q[:kept])
    with Reader(bag) as reader:
        times = [received for _, received, _ in reader.messages()]
    assert times == sorted(times)
    assert run(monkeypatch, 'recover', bag) == 0
    assert 'every file is whole' in capsys.readouterr().out


def test_a_file_that_the_metadata_does_not_name_is_not_left_out_without_a_word(own, tmp_path):
    """A recorder that was killed, or that a full disk stopped, before it wrote the metadata of its last file."""
    bag = rosbag2.convert(own, tmp_path / 'other', files=2)
    with rosbag2.edited(bag / 'metadata.yaml') as content:
        content['relative_file_paths'].pop()
        content['files'].pop()
    with pytest.raises(BagReadError, match=r'metadata\.yaml does not name other_1\.mcap; `shared-control recover'):
        read_bag(bag)
    recover(bag)
    equal(read_bag(bag), read_bag(own))


def test_a_file_that_play_has_unpacked_beside_the_compressed_one_is_in_nobodys_way(own, tmp_path):
    bag = rosbag2.convert(own, tmp_path / 'other', compression='file')
    packed, = bag.glob('*.zstd')
    rosbag2.convert(own, tmp_path / 'plain').joinpath('plain_0.mcap').rename(packed.with_suffix(''))
    equal(read_bag(bag), read_bag(own))
    assert recover(bag) == []
    equal(read_bag(bag), read_bag(own))


def test_a_torn_file_under_another_name_is_finished_too(own, tmp_path, monkeypatch, capsys):
    bag = rosbag2.convert(own, tmp_path / 'other')
    path, = bag.glob('*.mcap')
    (bag / 'metadata.yaml').unlink()
    renamed = path.rename(bag / 'monday.mcap')
    renamed.write_bytes(renamed.read_bytes()[:renamed.stat().st_size * 2 // 3])
    assert run(monkeypatch, 'recover', bag) == 0
    assert 'messages kept' in capsys.readouterr().out
    assert len(read_bag(bag).joint_states.stamp_ns)


def test_a_bag_of_several_robots_names_them(own, tmp_path):
    bag = rosbag2.convert(own, tmp_path / 'one', rename=lambda topic: {
        '/joint_states': '/a/joint_states', '/ball': '/b/joint_states'}.get(topic, topic))
    with pytest.raises(BagReadError, match=r'several robots \(/a, /b\)'):
        read_bag(bag)


def test_names_in_a_bag_are_told_short_and_harmless(tmp_path):
    with pytest.raises(BagReadError, match=r'several robots \(/\\x1b\[31mred') as error:
        recorded_namespace(tmp_path, [f'/\x1b[31mred{number}/joint_states' for number in range(1000)])
    assert '\x1b' not in str(error.value) and len(str(error.value)) < 1000


def test_a_burst_of_late_messages_is_no_false_alarm(own, tmp_path):
    """A recorder on a busy machine gets /target_wrench up to a second late; stamps decide, not when it came."""
    recording = made.record([made.lesson(100)])
    late = {topic.full_name for topic in made.APPLIED}
    first = made.START_NS + 500 * made.MS
    recording.messages = [
        (topic, max(at, first + 900 * made.MS) if topic.full_name in late and at >= first else at, content)
        for topic, at, content in recording.messages]
    assert check_bag(read_bag(recording.write(tmp_path / 'bag'))) == []


def test_report_says_that_a_converted_bag_has_no_record_of_the_session(own, tmp_path, monkeypatch, capsys):
    bag = rosbag2.convert(own, tmp_path / 'other')
    assert run(monkeypatch, 'report', bag, '--output', tmp_path / 'report') == 0
    assert 'has no record of the session' in capsys.readouterr().err
    annotate(bag, 'shared_control_session', {'settings.json': '{"preset": "coached", "tutor": "keyboard"}'})
    assert run(monkeypatch, 'report', bag, '--output', tmp_path / 'again') == 0
    assert 'no record' not in capsys.readouterr().err


def test_a_compressed_bag_is_not_annotated(own, tmp_path):
    bag = rosbag2.convert(own, tmp_path / 'other', compression='file')
    with pytest.raises(OSError, match=r'compressed files, \.mcap\.zstd, are not written to'):
        annotate(bag, 'note', {})


def test_contract_topics_that_nobody_published_are_named(own, tmp_path):
    """`ros2 bag record` without --include-unpublished-topics leaves them out."""
    found = check_bag(read_bag(rosbag2.convert(own, tmp_path / 'other')))
    assert f'{contract.DISTURBANCE.full_name} was not recorded' in found


@pytest.mark.parametrize(('node', 'command'), [
    ('torque_ctrl_node', ['report']), ('panda_sim_node', ['export']), ('robot1/torque_ctrl_node', ['report'])])
def test_a_bag_without_a_record_is_of_the_task_that_its_nodes_reported(tmp_path, monkeypatch, capsys, node, command):
    """`ros2 bag record` beside a graph that runs another task: nobody says which when the bag is read."""
    recording = made.record([made.lesson(100)])
    recording.add(contract.DIAGNOSTICS, made.START_NS + made.MS, made.status(made.START_NS, node, task='detour'))
    bag = recording.write(tmp_path / 'bag')
    assert read_bag(bag).task.name == 'detour' and len(read_bag(bag).applied.moment[0]) == 2
    assert run(monkeypatch, *command, bag, '--output', tmp_path / 'out') == 0
    if command == ['report']:
        assert json.loads((tmp_path / 'out' / 'summary.json').read_text())['task'] == 'detour'
    else:
        assert 'm_x_applied' in pd.read_parquet(tmp_path / 'out')


def test_what_a_session_kept_of_its_task_goes_before_what_nodes_report(tmp_path):
    recording = made.record([made.lesson(50)])
    recording.add(contract.DIAGNOSTICS, made.START_NS + made.MS, made.status(made.START_NS, 'other', task='detour'))
    bag = recording.write(tmp_path / 'session' / 'bag')
    (bag.parent / 'settings.json').write_text('{"task": "plate"}')
    for path in (bag, find_bag(bag.parent)):
        assert read_bag(path).task.name == 'plate'


def test_a_task_that_is_not_installed_is_named(tmp_path):
    recording = made.record([made.lesson(50)])
    recording.add(contract.DIAGNOSTICS, made.START_NS + made.MS, made.status(made.START_NS, 'x', task='juggle'))
    with pytest.raises(BagReadError, match="no task 'juggle'; there are balance, detour, plate"):
        read_bag(recording.write(tmp_path / 'bag'))
