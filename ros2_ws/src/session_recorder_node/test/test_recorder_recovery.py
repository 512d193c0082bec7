"""Unfinished files, cut anywhere."""

import pytest
import yaml
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader
from session_recorder_node import BagError, annotate, recover
from session_recorder_node.bag_writer import BagWriter
from session_recorder_node.latched import last_sent
from shared_control_ros import contract

CHUNKS, PER_CHUNK = 3, 4


def record(bag, finish=True):
    """A file of three chunks of four messages on two topics; an unfinished one has its file closed all the same."""
    writer = BagWriter(bag)
    channels = [writer.add_topic(f'/{topic.name}', topic.msg_type, topic.qos)
                for topic in (contract.JOINT_STATES, contract.EPISODE)]
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


def test_a_spoilt_last_chunk_is_dropped(tmp_path):
    path, ends = record(tmp_path / 'bag', finish=False)
    content = bytearray(path.read_bytes())
    content[ends[-2] + 80:ends[-2] + 90] = bytes(10)
    path.write_bytes(content)
    [recovered] = recover(tmp_path / 'bag')
    assert recovered.messages == (CHUNKS - 1) * PER_CHUNK
    assert len(messages(path)) == recovered.messages


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


def test_the_newest_message_of_a_latched_topic_is_found(tmp_path):
    path, _ = record(tmp_path / 'bag')
    newest = CHUNKS * PER_CHUNK - 1
    assert last_sent([path], ['/training/episode', '/training/phase']) == {'/training/episode': newest}


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
    path.write_bytes(path.read_bytes()[:-100])
    recover(tmp_path / 'bag')
    assert path.read_bytes() == plain
