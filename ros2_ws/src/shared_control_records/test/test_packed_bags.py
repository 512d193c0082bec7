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

"""Bags that say of their chunks what is not so: they are refused before they take all memory."""

import tracemalloc
from types import SimpleNamespace

import lz4.frame
import pytest
import zstandard
from mcap.writer import IndexType, Writer
from shared_control_records.bag import BagError, recover, unpack
from shared_control_records.bag.metadata import is_finished
from shared_control_records.bag.reader import BagReadError, read_bag
from shared_control_records.bag.task import session_record
from shared_control_testing import rosbag2
from shared_control_testing import sessions as made

LARGE = bytes(20_000_000)
SILENT = zstandard.ZstdCompressor(write_content_size=False)


@pytest.fixture(scope='module')
def own(tmp_path_factory):
    """With chunks compressed by zstd."""
    folder = tmp_path_factory.mktemp('made')
    return rosbag2.convert(made.record([made.lesson(50)]).write(folder / 'one'), folder / 'bag')


@pytest.fixture
def smallest(monkeypatch):
    """No chunk may be as large as those of a recorder."""
    monkeypatch.setattr(unpack, 'CHUNK_MOST', 100)


@pytest.mark.parametrize(('compression', 'packed'), [
    ('zstd', zstandard.compress(LARGE)), ('zstd', SILENT.compress(LARGE)), ('lz4', lz4.frame.compress(LARGE))],
    ids=['zstd', 'zstd that does not say its size', 'lz4'])
def test_a_chunk_gives_what_it_says_or_nothing(compression, packed):
    assert unpack.unpack(compression, packed, len(LARGE)) == LARGE
    for size, packed_otherwise in ((1000, packed), (len(LARGE), packed[:-8]), (len(LARGE), b'spoilt')):
        tracemalloc.start()
        with pytest.raises(unpack.SpoiltError, match='is damaged'):
            unpack.unpack(compression, packed_otherwise, size)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert size == len(LARGE) or peak < 1_000_000


def test_what_others_compress_with_is_named():
    with pytest.raises(unpack.UnpackError, match="is compressed by 'brotli', expected zstd or lz4"):
        unpack.unpack('brotli', b'', 0)


def test_a_bag_with_a_chunk_that_is_too_large_is_refused_with_its_place(own, smallest):
    file, = own.glob('*.mcap')
    with pytest.raises(BagReadError, match=rf'a chunk says that it has \d+ bytes, .* at byte \d+ of {file}'):
        read_bag(own)


def test_so_is_one_without_an_index(own, tmp_path, smallest):
    path = tmp_path / 'without.mcap'
    with path.open('wb') as file, pytest.MonkeyPatch.context() as patch:
        patch.setattr(unpack, 'CHUNK_MOST', 10**9)
        writer = Writer(file, index_types=IndexType.NONE, use_statistics=False, use_summary_offsets=False,
                        repeat_schemas=False, repeat_channels=False)
        writer.start(profile='ros2')
        for schema, channel, message in rosbag2.entries(own):
            registered = writer.register_schema(schema.name, schema.encoding, schema.data)
            writer.add_message(writer.register_channel(channel.topic, 'cdr', registered), message.log_time,
                               message.data, message.publish_time)
        writer.finish()
    for read in (read_bag, session_record):
        with pytest.raises(BagReadError, match=r'says that it has \d+ bytes, expected 100 at the most'):
            read(path)


@pytest.mark.parametrize('packed', [
    zstandard.compress(LARGE), SILENT.compress(LARGE), *(
        zstandard.compress(first) + zstandard.compress(LARGE) for first in (b'', b'small'))],
    ids=['large', 'large and does not say so', 'behind nothing', 'behind another'])
def test_so_is_one_with_a_message_that_is_too_large(own, tmp_path, monkeypatch, packed):
    compressor = SimpleNamespace(compress=lambda _: packed)
    monkeypatch.setattr(rosbag2, 'zstandard', SimpleNamespace(ZstdCompressor=lambda: compressor))
    bag = rosbag2.convert(own, tmp_path / 'bag', compression='message')
    monkeypatch.setattr(unpack, 'CHUNK_MOST', 1_000_000)
    with pytest.raises(BagReadError, match=rf'cannot read the bag {bag}: a message (says|is damaged)'):
        read_bag(bag)


def test_a_recording_with_such_a_chunk_is_left_as_it_is(own, tmp_path, smallest):
    whole, = own.glob('*.mcap')
    torn = tmp_path / 'bag' / 'bag_0.mcap'
    torn.parent.mkdir()
    torn.write_bytes(whole.read_bytes()[:-100])
    assert not is_finished(torn)
    with pytest.raises(BagError, match=rf'{torn} is left as it is, .* a chunk says .* it ends at byte \d+'):
        recover(torn.parent)
    assert torn.read_bytes() == whole.read_bytes()[:-100]
