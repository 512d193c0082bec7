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

"""Bags of many minutes: read a chunk at a time, to the same content, in memory that grows little with each minute."""

import tracemalloc

import numpy as np
import pytest
from shared_control_records.bag import chunks, reader
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.reader import read_bag
from shared_control_records.bag.writer import BagWriter
from shared_control_records.session.report import write_report
from shared_control_testing.long_sessions import LESSONS, write_long_session

MB_A_MINUTE = 7.0
"""45 minutes of this, and 150 MB of libraries, are less than 500 MB."""


@pytest.fixture(scope='module')
def minute(tmp_path_factory):
    return write_long_session(tmp_path_factory.mktemp('one') / 'session', 1)


@pytest.fixture(scope='module')
def minutes(tmp_path_factory):
    return write_long_session(tmp_path_factory.mktemp('two') / 'session', 2)


def assert_same(one, other, name='bag'):
    """Compare all that is in two bags."""
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other, name)
    elif isinstance(one, dict):
        assert list(one) == list(other), name
        for key in one:
            assert_same(one[key], other[key], f'{name}[{key}]')
    elif hasattr(one, '__dict__') and type(one).__module__.startswith('shared_control_records'):
        for key, value in vars(one).items():
            assert_same(value, getattr(other, key), f'{name}.{key}')
    elif name != 'bag.task':
        assert one == other, name


@pytest.mark.parametrize('way', ['message by message', 'chunk by chunk', 'without the index'])
def test_chunks_give_what_single_messages_give(minute, monkeypatch, way):
    by_chunks = read_bag(minute.bag)
    used = []
    if way == 'message by message':
        def blocks(_):
            used.append(way)
            raise chunks.OutOfOrder
        monkeypatch.setattr(reader, 'read_blocks', blocks)
    elif way == 'chunk by chunk':
        groups = chunks._groups
        monkeypatch.setattr(chunks, 'WORTHWHILE', 0)
        monkeypatch.setattr(chunks, '_groups', lambda found: used.extend(groups(found)) or iter(used))
    else:
        monkeypatch.setattr(chunks, '_indexed', lambda *_: used.append(way))
    assert_same(by_chunks, read_bag(minute.bag))
    assert used and (way != 'chunk by chunk' or len(used) > 200)
    assert by_chunks.counts['/joint_states'] == 60_000


def test_chunks_that_overlap_in_time_are_taken_together():
    """An out-of-order spot costs no more than the rest; where too many overlap, messages are added one by one."""
    def chunk(first, last, size=chunks.WORTHWHILE):
        return chunks.ChunkInfo(first, last, 1000 * first, 0, {}, 0, '', 0, size, {})

    apart = [chunk(0, 10), chunk(10, 20), chunk(20, 30)]
    assert list(chunks._groups(reversed(apart))) == [[one] for one in apart]
    overlapping = [chunk(0, 10), chunk(8, 20), chunk(19, 30), chunk(30, 40)]
    assert list(chunks._groups(overlapping)) == [overlapping[:3], overlapping[3:]]
    small = [chunk(first, first + 1, chunks.WORTHWHILE // 4) for first in range(6)]
    assert list(map(len, chunks._groups(small))) == [4, 2]
    endless = [chunk(first, 10_000, chunks.AT_MOST // 4) for first in range(9)]
    assert list(map(len, chunks._groups(endless))) == [4, 4, 1]


def test_an_index_that_leaves_a_message_out_is_not_believed(minute):
    path, = minute.bag.glob('*.mcap')
    storage = chunks.McapReader(path)
    storage.open()
    content, index = chunks._read(storage.bio, storage.chunks[0])
    storage.close()
    found = chunks._indexed(content, [index], [0])
    assert found is not None and len(found.offsets) == len(chunks._walked(content).offsets) > 100
    _, length, *_ = chunks._INDEX_HEAD.unpack_from(index)
    without_a_topic = index[chunks._RECORD.size + length:]
    assert chunks._indexed(content, [without_a_topic], [0]) is None
    entry = chunks._INDEX_HEAD.size
    one_time_wrong = bytearray(index)
    one_time_wrong[entry] ^= 1
    assert chunks._indexed(content, [bytes(one_time_wrong)], [0]) is None
    one_place_wrong = bytearray(index)
    one_place_wrong[entry + 8] ^= 1
    assert chunks._indexed(content, [bytes(one_place_wrong)], [0]) is None


def test_each_minute_takes_little_memory(minute, minutes):
    """A bag and its check; what reading takes besides does not depend on the length."""
    def peak(folder):
        tracemalloc.start()
        try:
            bag = read_bag(folder.bag)
            tracemalloc.reset_peak()
            assert check_bag(bag) == []
            return tracemalloc.get_traced_memory()[1] / 1e6
        finally:
            tracemalloc.stop()

    peak(minute)  # what is made once
    assert peak(minutes) - peak(minute) < MB_A_MINUTE


def test_the_report_of_a_long_session(minutes):
    summary = write_report(minutes)
    assert summary.bag_checks == []
    assert summary.episodes_taught == 2 * LESSONS
    assert summary.duration_s == pytest.approx(120, abs=0.1)


def test_a_recorder_needs_no_more_memory_the_more_files_there_are(tmp_path):
    def add_file():
        writer = BagWriter(tmp_path / 'bag')
        channels = [writer.add_topic(f'/topic{number}', 'std_msgs/msg/Int32', 'int32 data', 'RIHS01_0', '')
                    for number in range(10)]
        for second in range(200):
            for channel in channels:
                writer.write(channel, bytes(8), second, second)
            writer.flush()
        tracemalloc.start()
        writer.finish()
        BagWriter(tmp_path / 'bag').finish()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    peaks = [add_file() for _ in range(5)]
    assert peaks[-1] < 1.2 * peaks[1], peaks
