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

"""Unfinished files, cut anywhere."""

import errno
import os
import subprocess
import sys

import pytest
import yaml
from mcap.reader import make_reader
from mcap.writer import MCAP0_MAGIC, Writer
from rosbags.rosbag2 import Reader
from shared_control_records.bag import BagError, annotate, recover
from shared_control_records.bag.last_sent import last_sent
from shared_control_records.bag.metadata import refuse_another_recorder
from shared_control_records.bag.writer import BagWriter

CHUNKS, PER_CHUNK = 3, 4
HASH = 'RIHS01_' + 64 * '0'
QOS = '[]'


def record(bag, finish=True):
    """A file of three chunks of four messages on two topics; an unfinished one has its file closed all the same."""
    writer = BagWriter(bag)
    channels = [writer.add_topic(name, type_name, f'{field} data\n', HASH, QOS) for name, type_name, field in (
        ('/joint_states', 'std_msgs/msg/Float64', 'float64'), ('/training/episode', 'std_msgs/msg/Int32', 'int32'))]
    ends = [writer.path.stat().st_size]
    for chunk in range(CHUNKS):
        for message in range(PER_CHUNK):
            number = chunk * PER_CHUNK + message
            writer.write(channels[number % 2], f'message {number:4}'.encode() * 9, number, number + 1, number + 1)
        writer.flush()
        ends.append(writer.path.stat().st_size)
    if finish:
        writer.finish()
    else:
        writer._file.close()
    return writer.path, ends


def messages(path):
    with path.open('rb') as file:
        return [message.data for _, _, message in make_reader(file, validate_crcs=True).iter_messages()]


def test_a_finished_file_equals_one_that_was_killed_and_recovered(tmp_path):
    finished, _ = record(tmp_path / 'a')
    killed, _ = record(tmp_path / 'b', finish=False)
    [recovered] = recover(tmp_path / 'b')
    assert (recovered.path, recovered.messages, recovered.cut) == (killed, CHUNKS * PER_CHUNK, 0)
    assert killed.read_bytes() == finished.read_bytes()
    described = [(tmp_path / bag / 'metadata.yaml').read_text() for bag in 'ab']
    assert described[0].replace('a_0', 'b_0') == described[1]


def test_wherever_a_file_is_cut_all_whole_chunks_are_kept(tmp_path):
    path, ends = record(tmp_path / 'bag', finish=False)
    whole, all_messages = path.read_bytes(), None
    for size in range(len(whole), -1, -29):
        (tmp_path / 'bag' / 'metadata.yaml').unlink(missing_ok=True)
        path.write_bytes(whole[:size])
        recover(tmp_path / 'bag')
        if size < ends[1] and not path.exists():
            continue
        kept = messages(path)
        all_messages = all_messages or kept
        assert kept == all_messages[:len(kept)]
        assert len(kept) >= PER_CHUNK * sum(end <= size for end in ends[1:])
        assert len(kept) % PER_CHUNK == 0
        with Reader(tmp_path / 'bag') as reader:
            assert [bytes(data) for _, _, data in reader.messages()] == kept
            assert reader.message_count == len(kept)


def test_a_recovery_that_is_cut_short_can_be_repeated(tmp_path):
    path, ends = record(tmp_path / 'bag')
    whole = path.read_bytes()
    for size in range(ends[-1], len(whole), 97):
        path.write_bytes(whole[:size])
        recover(tmp_path / 'bag')
        assert path.read_bytes() == whole


def test_something_else_can_be_done_after_every_chunk(tmp_path):
    record(tmp_path / 'bag', finish=False)
    done = []
    recover(tmp_path / 'bag', meanwhile=lambda: done.append(1))
    assert len(done) == CHUNKS


def test_a_spoilt_last_chunk_is_dropped(tmp_path):
    path, ends = record(tmp_path / 'bag', finish=False)
    content = bytearray(path.read_bytes())
    content[ends[-2] + 80:ends[-2] + 90] = bytes(10)
    path.write_bytes(content)
    [recovered] = recover(tmp_path / 'bag')
    assert recovered.messages == (CHUNKS - 1) * PER_CHUNK
    assert len(messages(path)) == recovered.messages


def test_a_file_that_is_spoilt_before_its_end_is_left_as_it_is(tmp_path):
    path, ends = record(tmp_path / 'bag', finish=False)
    content = bytearray(path.read_bytes())
    content[ends[1] + 80:ends[1] + 90] = bytes(10)
    path.write_bytes(content)
    with pytest.raises(BagError, match='is damaged before its end'):
        recover(tmp_path / 'bag')
    assert path.read_bytes() == content


@pytest.mark.parametrize('flip', [0x01, 0x08, 0x40])
def test_whichever_bit_is_flipped_no_whole_chunk_before_the_last_is_lost(tmp_path, flip):
    """Not in silence: the file is left as it is, then."""
    path, ends = record(tmp_path / 'bag', finish=False)
    whole, refused = path.read_bytes(), 0
    for place in range(len(MCAP0_MAGIC), len(whole), 5):
        content = bytearray(whole)
        content[place] ^= flip
        path.write_bytes(content)
        try:
            recover(tmp_path / 'bag')
        except BagError:
            refused += 1
            assert path.read_bytes() == content
            continue
        kept = messages(path)
        lost = PER_CHUNK if place >= ends[-2] else 0
        assert len(kept) >= CHUNKS * PER_CHUNK - lost, f'byte {place}'
        path.unlink()
    assert refused > 10


@pytest.mark.parametrize('chunk', range(CHUNKS))
def test_a_page_of_zeros_in_the_middle_is_damage(tmp_path, chunk):
    path, ends = record(tmp_path / 'bag', finish=False)
    content = bytearray(path.read_bytes())
    content[ends[chunk]:ends[chunk] + 60] = bytes(60)
    path.write_bytes(content)
    if chunk < CHUNKS - 1:
        with pytest.raises(BagError, match=r'is damaged before its end \(about byte'):
            recover(tmp_path / 'bag')
        assert path.read_bytes() == content
    else:  # nobody can tell that from a writer that was killed
        [recovered] = recover(tmp_path / 'bag')
        assert recovered.messages == chunk * PER_CHUNK


def test_zeros_that_a_power_cut_leaves_are_cut_off(tmp_path):
    path, _ = record(tmp_path / 'bag', finish=False)
    path.write_bytes(path.read_bytes() + bytes(5000))
    [recovered] = recover(tmp_path / 'bag')
    assert (recovered.messages, recovered.cut) == (CHUNKS * PER_CHUNK, 5000)


def test_metadata_that_was_not_written_any_more_is_made_anew(tmp_path):
    record(tmp_path / 'bag')
    text = (tmp_path / 'bag' / 'metadata.yaml').read_text()
    (tmp_path / 'bag' / 'metadata.yaml').unlink()
    assert recover(tmp_path / 'bag') == []
    assert (tmp_path / 'bag' / 'metadata.yaml').read_text() == text


def test_a_whole_bag_is_left_as_it_is(tmp_path):
    path, _ = record(tmp_path / 'bag')
    metadata = tmp_path / 'bag' / 'metadata.yaml'
    metadata.write_text(metadata.read_text().replace('custom_data: null', 'custom_data: {mine: kept}'))
    before = path.read_bytes(), metadata.read_text()
    assert recover(tmp_path / 'bag') == []
    assert (path.read_bytes(), metadata.read_text()) == before


def test_files_are_numbered_on_beyond_nine(tmp_path):
    for _ in range(11):
        path, _ = record(tmp_path / 'bag')
    assert path.name == 'bag_10.mcap'
    described = yaml.safe_load((tmp_path / 'bag' / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert described['relative_file_paths'] == [f'bag_{number}.mcap' for number in range(11)]
    assert described['message_count'] == 11 * CHUNKS * PER_CHUNK


def test_what_is_no_recording_is_not_touched(tmp_path):
    (tmp_path / 'bag').mkdir()
    foreign = tmp_path / 'bag' / 'bag_0.mcap'
    foreign.write_text('something else altogether')
    with pytest.raises(BagError, match='is no MCAP file'):
        recover(tmp_path / 'bag')
    assert foreign.read_text() == 'something else altogether'
    with pytest.raises(BagError, match='there is no bag at'):
        recover(tmp_path / 'nowhere')


def test_a_bag_that_is_being_recorded_is_not_touched(tmp_path):
    writer = BagWriter(tmp_path / 'bag')
    with pytest.raises(BagError, match='is being recorded by another process'):
        recover(tmp_path / 'bag')
    assert writer.path.exists()
    writer.finish()
    assert recover(tmp_path / 'bag') == []


def record_elsewhere(path, finish):
    """Another program's file of two messages without a schema, as Foxglove has them of JSON."""
    path.parent.mkdir(exist_ok=True)
    with path.open('wb') as file:
        writer = Writer(file)
        writer.start('', 'another program')
        channel = writer.register_channel('/chat', 'json', 0)
        for number in range(2):
            writer.add_message(channel, number, b'{}', number)
        writer.finish() if finish else writer.flush()


@pytest.mark.parametrize('names', [
    ['bag_0.mcap'], ['bag_0.db3'], ['bag_0.mcap.zstd', 'metadata.yaml'], ['metadata.yaml']])
def test_what_another_recorder_has_written_is_not_recorded_into(tmp_path, names):
    record_elsewhere(tmp_path / names[0], finish=True)
    for name in names[1:]:
        (tmp_path / name).write_text('of another one')
    with pytest.raises(BagError, match=f'{names[0]} is of another recorder.* record into another folder'):
        refuse_another_recorder(tmp_path)


def test_a_folder_without_a_bag_is_recorded_into_and_so_is_one_of_ours(tmp_path):
    (tmp_path / 'notes.txt').write_text('mine')
    refuse_another_recorder(tmp_path)
    refuse_another_recorder(tmp_path / 'not there yet')
    path, _ = record(tmp_path, finish=False)
    refuse_another_recorder(tmp_path)
    path.write_bytes(b'')  # as a full disk leaves it
    refuse_another_recorder(tmp_path)


@pytest.mark.parametrize('begun', [False, True])
def test_a_recorder_does_not_finish_what_another_one_may_still_be_writing(tmp_path, begun):
    """It has come into the folder of a recording that goes on."""
    path = tmp_path / 'bag' / 'bag_0.mcap'
    record_elsewhere(path, finish=False)
    if begun:
        path.write_bytes(b'')
    before, inode = path.read_bytes(), path.stat().st_ino
    record(tmp_path / 'bag')
    assert (path.read_bytes(), path.stat().st_ino) == (before, inode)
    [recovered] = recover(tmp_path / 'bag')
    assert recovered.messages == (0 if begun else 2), 'by hand it is finished'


def test_what_somebody_has_added_to_the_metadata_stays(tmp_path):
    record(tmp_path / 'bag')
    path = tmp_path / 'bag' / 'metadata.yaml'
    content = yaml.safe_load(path.read_text())
    content['rosbag2_bagfile_information'] |= {'custom_data': {'place': 'lab 3'}, 'mine': 1}
    path.write_text(yaml.safe_dump({**content, 'also_mine': 2}))
    record(tmp_path / 'bag')
    new = yaml.safe_load(path.read_text())
    described = new['rosbag2_bagfile_information']
    assert (described['custom_data'], described['mine'], new['also_mine']) == ({'place': 'lab 3'}, 1, 2)
    assert described['relative_file_paths'] == ['bag_0.mcap', 'bag_1.mcap']


def test_messages_without_a_schema_are_described_and_kept(tmp_path):
    record_elsewhere(tmp_path / 'bag' / 'bag_0.mcap', finish=True)
    record_elsewhere(tmp_path / 'bag' / 'bag_1.mcap', finish=False)
    [recovered] = recover(tmp_path / 'bag')
    assert recovered.messages == 2
    described = yaml.safe_load((tmp_path / 'bag' / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    [topic] = described['topics_with_message_count']
    assert (topic['topic_metadata']['type'], topic['message_count']) == ('', 4)


def test_a_bag_needs_no_ros():
    used = 'import sys, shared_control_records.bag.writer, shared_control_records.bag.last_sent'
    subprocess.run([sys.executable, '-c', f'{used}; assert "rclpy" not in sys.modules'], check=True)


def test_the_newest_messages_of_latched_topics_are_found_across_files(tmp_path):
    paths = [record(tmp_path / 'bag')[0] for _ in range(2)]
    sent = {number for number in range(CHUNKS * PER_CHUNK) if number % 2}
    assert last_sent(paths, {'/training/episode': 2, '/training/phase': 5}) == {
        '/training/episode': set(sorted(sent)[-2:]), '/training/phase': set()}
    assert last_sent(paths, {'/training/episode': 100}) == {'/training/episode': sent}


def test_an_annotation_stands_in_the_file_and_a_torn_one_costs_no_message(tmp_path):
    path, _ = record(tmp_path / 'bag')
    before, plain = messages(path), path.read_bytes()
    annotate(tmp_path / 'bag', 'note', {'key': 'old'})
    annotate(tmp_path / 'bag', 'note', {'key': 'new'})
    with path.open('rb') as file:
        notes = [record.metadata for record in make_reader(file).iter_metadata() if record.name == 'note']
    assert notes == [{'key': 'new'}]
    assert messages(path) == before
    with Reader(tmp_path / 'bag') as reader:
        assert reader.message_count == CHUNKS * PER_CHUNK

    annotated = path.read_bytes()
    path.write_bytes(annotated[:-100])  # the index alone is torn
    recover(tmp_path / 'bag')
    assert path.read_bytes() == annotated
    path.write_bytes(annotated[:annotated.index(b'new')])
    recover(tmp_path / 'bag')
    assert path.read_bytes() == plain


def test_a_damaged_file_is_not_annotated(tmp_path):
    path, ends = record(tmp_path / 'bag')
    content = bytearray(path.read_bytes())
    content[ends[-2] + 80:ends[-2] + 90] = bytes(10)
    path.write_bytes(content)
    with pytest.raises(BagError, match='only 8 of 12 messages can be read'):
        annotate(tmp_path / 'bag', 'note', {'key': 'value'})
    assert path.read_bytes() == content


def test_an_annotation_leaves_those_of_other_names(tmp_path):
    path, _ = record(tmp_path / 'bag')
    for name in ('one', 'two', 'one'):
        annotate(tmp_path / 'bag', name, {'of': name})
    with path.open('rb') as file:
        assert [record.name for record in make_reader(file).iter_metadata()] == ['rosbag2', 'two', 'one']


def test_a_bag_without_a_message_can_be_annotated(tmp_path):
    writer = BagWriter(tmp_path / 'bag')
    writer.finish()
    annotate(tmp_path / 'bag', 'note', {'key': 'value'})
    with writer.path.open('rb') as file:
        assert [record.name for record in make_reader(file).iter_metadata()] == ['rosbag2', 'note']


@pytest.mark.parametrize('change', [recover, lambda bag: annotate(bag, 'note', {})])
def test_a_copy_that_fails_leaves_the_file_as_it_was(tmp_path, monkeypatch, change):
    path, _ = record(tmp_path / 'bag', finish=change is not recover)
    before = path.read_bytes()

    def no_room(_):
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as patched:
        patched.setattr(os, 'fsync', no_room)
        with pytest.raises(OSError, match='No space left'):
            change(tmp_path / 'bag')
    assert path.read_bytes() == before
    assert not list((tmp_path / 'bag').glob('*.tmp'))
    change(tmp_path / 'bag')
    assert len(messages(path)) == CHUNKS * PER_CHUNK
