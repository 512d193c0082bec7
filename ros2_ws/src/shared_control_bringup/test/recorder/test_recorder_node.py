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

"""The recorder on a running graph; its bags are read back by packages that know nothing of it."""

import resource
import signal
import time

import pytest
import yaml
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from shared_control_records.bag import recover
from shared_control_records.bag.reader import read_bag
from shared_control_ros import contract
from shared_control_testing.faults.machine import Machine

ALL_TOPICS = {topic.full_name for topic in contract.BAG_TOPICS}


def read_with_rosbags(bag):
    """Topic -> the serialized messages in the order of their arrival."""
    with Reader(bag) as reader:
        return by_topic(reader)


def by_topic(reader):
    messages = {connection.topic: [] for connection in reader.connections}
    for connection, _, data in reader.messages():
        messages[connection.topic].append(bytes(data))
    return messages


def read_with_mcap(path):
    """Topic -> the MCAP message records."""
    messages = {}
    with path.open('rb') as file:
        for _, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            messages.setdefault(channel.topic, []).append(message)
    return messages


def metadata(bag):
    return yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']


def test_everything_is_recorded_as_rosbag2_does(start_recorder, traffic, tmp_path):
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag)
    traffic.wait_for_recorder()
    traffic.run(3.0)
    hashes = {topic: str(traffic.node.get_publishers_info_by_topic(topic)[0].topic_type_hash)
              for topic in traffic.sent}
    code, errors = recorder.stop(signal.SIGINT)
    assert code == 0, errors

    # Every byte of every message, once, in order; and the bag explains itself.
    with AnyReader([bag]) as reader:  # checks each definition against its hash
        recorded = by_topic(reader)
        states = [reader.deserialize(data, 'sensor_msgs/msg/JointState') for data in recorded['/joint_states']]
        report = reader.deserialize(recorded['/diagnostics'][-1], 'diagnostic_msgs/msg/DiagnosticArray').status[0]
    assert recorded.keys() == ALL_TOPICS
    assert len(traffic.sent['/joint_states']) == 3000
    for topic, sent in traffic.sent.items():
        assert recorded[topic] == sent, topic
    assert [state.position[0] for state in states] == list(range(3000))
    assert report.name == '/session_recorder_node'
    assert {value.key: value.value for value in report.values}['lost'] == '0'

    # The publishers' own count shows no gap, and the times make sense.
    for topic, messages in read_with_mcap(bag / 'bag_0.mcap').items():
        assert [message.sequence for message in messages] == list(range(1, len(messages) + 1)), topic
        assert all(0 <= message.log_time - message.publish_time < 2e9 for message in messages), topic

    # The metadata are those of rosbag2.
    described = metadata(bag)
    assert described['version'] == 9
    assert described['storage_identifier'] == 'mcap'
    assert described['relative_file_paths'] == ['bag_0.mcap']
    assert described['message_count'] == sum(len(messages) for messages in recorded.values())
    assert 2.9e9 < described['duration']['nanoseconds'] < 15e9
    topics = {entry['topic_metadata']['name']: entry for entry in described['topics_with_message_count']}
    assert {topic: entry['message_count'] for topic, entry in topics.items()} == {
        topic: len(messages) for topic, messages in recorded.items()}
    for topic, type_hash in hashes.items():
        assert topics[topic]['topic_metadata']['type_description_hash'] == type_hash
    [offered] = topics['/training/episode']['topic_metadata']['offered_qos_profiles']
    assert (offered['durability'], offered['reliability'], offered['history']) == (
        'transient_local', 'reliable', 'keep_last')

    with (bag / 'bag_0.mcap').open('rb') as file:
        reader = make_reader(file)
        assert reader.get_header().profile == 'ros2'
        assert next(reader.iter_metadata()).name == 'rosbag2'
        summary = reader.get_summary()
    for channel in summary.channels.values():
        schema = summary.schemas[channel.schema_id]
        assert (channel.message_encoding, schema.encoding) == ('cdr', 'ros2msg')
        assert channel.metadata['topic_type_hash'] == topics[channel.topic]['topic_metadata']['type_description_hash']
        assert yaml.safe_load(channel.metadata['offered_qos_profiles']) == (
            topics[channel.topic]['topic_metadata']['offered_qos_profiles'])


def test_a_long_recording_goes_on_in_other_files_without_a_gap(start_recorder, traffic, tmp_path):
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag, split_minutes=0.01, split_megabytes=0.0)
    traffic.wait_for_recorder()
    traffic.run(3.0)
    code, errors = recorder.stop(signal.SIGINT)
    assert code == 0, errors
    recorded = read_with_rosbags(bag)
    for topic, sent in traffic.sent.items():
        assert recorded[topic] == sent, topic
    files = sorted(path.name for path in bag.glob('*.mcap'))
    assert len(files) > 2 and sorted(metadata(bag)['relative_file_paths']) == files
    counts = [len(read_with_mcap(bag / name).get('/joint_states', [])) for name in files]
    assert sum(counts) == 3000 and sum(count > 0 for count in counts) > 1


def test_what_was_on_its_way_when_it_was_stopped_is_in_the_bag(start_recorder, traffic, tmp_path):
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag)
    traffic.wait_for_recorder()
    recorder.process.send_signal(signal.SIGSTOP)  # as a busy machine holds it up
    traffic.run(0.1)
    recorder.process.send_signal(signal.SIGINT)
    code, errors = recorder.stop(signal.SIGCONT)
    assert code == 0, errors
    recorded = read_with_rosbags(bag)
    for topic, sent in traffic.sent.items():
        assert recorded.get(topic, []) == sent, topic


def test_a_killed_recorder_loses_at_most_a_second_and_the_next_goes_on(start_recorder, traffic, tmp_path):
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag)
    traffic.wait_for_recorder()
    traffic.publish(contract.EPISODE, contract.EPISODE.msg_type(data=1))
    traffic.run(1.0)
    killed_at = time.time_ns()
    assert recorder.stop(signal.SIGKILL)[0] == -signal.SIGKILL

    # Made whole by hand, as a supervisor does at the end of a session.
    [recovered] = recover(bag)
    first = read_with_mcap(bag / 'bag_0.mcap')
    assert recovered.messages == sum(len(messages) for messages in first.values())
    states = first['/joint_states']
    assert states[-1].publish_time > killed_at - 1e9
    assert [state.data for state in states] == traffic.sent['/joint_states'][:len(states)]
    assert recover(bag) == []
    before = (bag / 'bag_0.mcap').read_bytes()

    # The next recorder writes the next file and leaves the first alone.
    traffic.publish(contract.EPISODE, contract.EPISODE.msg_type(data=2))
    recorder = start_recorder(bag)
    second = bag / 'bag_1.mcap'
    traffic.run_until(lambda: second.exists() and second.stat().st_size > 30_000)
    traffic.wait_for_recorder()
    code, errors = start_recorder(bag).wait()
    assert code == 2
    assert f'error: {second} is being recorded by another process' in errors
    assert recorder.stop(signal.SIGTERM)[0] == 0
    assert (bag / 'bag_0.mcap').read_bytes() == before

    described = metadata(bag)
    assert [file['path'] for file in described['files']] == ['bag_0.mcap', 'bag_1.mcap']
    assert described['files'][0]['message_count'] == recovered.messages
    recorded = read_with_rosbags(bag)
    assert sum(len(messages) for messages in recorded.values()) == described['message_count']
    later = recorded['/joint_states'][len(states):]
    assert len(later) > 200
    assert later == traffic.sent['/joint_states'][-len(later):]
    assert recorded['/training/episode'] == traffic.sent['/training/episode']  # latched, but recorded once


def test_a_full_disk_is_said_and_what_was_recorded_is_kept(start_recorder, traffic, tmp_path):
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag, flush_period=0.05)
    traffic.wait_for_recorder()
    traffic.run(0.5)
    full = (bag / 'bag_0.mcap').stat().st_size + 1000
    resource.prlimit(recorder.process.pid, resource.RLIMIT_FSIZE, (full, full))  # as good as a full disk
    traffic.run(0.5)
    code, errors = recorder.wait()
    assert code == 2
    assert f'error: cannot write {bag}/bag_0.mcap: File too large' in errors
    assert '/shared_control_bringup/' not in errors  # no traceback of ours; `make coverage` has one of its own here
    recover(bag)
    states = read_with_rosbags(bag)['/joint_states']
    assert len(states) > 300
    assert states == traffic.sent['/joint_states'][:len(states)]


@pytest.mark.parametrize(('parameters', 'said'), [
    ({}, "parameter 'output' is missing"),
    ({'output': '{tmp}/file/bag'}, 'cannot record into {tmp}/file/bag: Not a directory'),
    ({'output': '{tmp}'}, '{tmp}/chat.db3 is of another recorder, which may still be writing: record into another'),
    ({'output': '{tmp}/bag', 'flush_period': 3.0}, "parameter 'flush_period' is out of range (0.05 to 0.5)"),
])
def test_what_cannot_work_is_said_in_one_line(start_recorder, tmp_path, parameters, said):
    (tmp_path / 'file').touch()
    (tmp_path / 'chat.db3').touch()
    given = {name: value.format(tmp=tmp_path) if isinstance(value, str) else value
             for name, value in parameters.items()}
    code, errors = start_recorder(**given).wait()
    assert code == 2
    [line] = [line for line in errors.splitlines() if line.startswith('error: ')]
    assert said.format(tmp=tmp_path) in line
    assert 'Traceback' not in errors


@pytest.fixture
def machine(tmp_path):
    machine = Machine(tmp_path)
    yield machine
    machine.close()


def test_a_clock_that_is_set_is_said_once_and_nothing_is_lost(start_recorder, traffic, tmp_path, machine):
    """Back by an hour and forward by two, while messages come."""
    bag = tmp_path / 'bag'
    recorder = start_recorder(bag, machine.environment)
    traffic.wait_for_recorder()
    traffic.run(1.0)
    for step in (-3600.0, 7200.0):
        machine.set_clock(step)
        traffic.run(1.5)
    code, errors = recorder.stop()
    assert code == 0, errors
    assert [line.partition("this machine's ")[2] for line in errors.splitlines() if 'clock was set' in line] == [
        'clock was set back by 3600.0 s: the bag goes on in another file, and nothing is lost',
        'clock was set forward by 7200.0 s, or it slept']

    files = metadata(bag)['relative_file_paths']
    assert files == ['bag_0.mcap', 'bag_1.mcap']
    in_file = [read_with_mcap(bag / name) for name in files]
    for topic, sent in traffic.sent.items():
        messages = [message for one in in_file for message in one.get(topic, [])]
        assert [message.data for message in messages] == sent, topic
        for one in in_file:
            times = [message.log_time for message in one.get(topic, [])]
            assert times == sorted(times), topic
    states = read_bag(bag, every_tick=True).joint_states
    assert len(states.received_ns) == len(traffic.sent['/joint_states'])
    assert (states.received_ns[1:] >= states.received_ns[:-1]).all()
    with AnyReader([bag]) as reader:
        reports = [reader.deserialize(data, 'diagnostic_msgs/msg/DiagnosticArray').status[0]
                   for data in by_topic(reader)['/diagnostics']]
    assert sum('clock was set back' in report.message for report in reports) == 1
    assert {value.key: value.value for value in reports[-1].values}['lost'] == '0'
