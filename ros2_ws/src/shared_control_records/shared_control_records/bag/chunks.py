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

"""The messages of an MCAP file, some chunks and in them a topic at a time, without touching each message by itself.

Behind each chunk stands an index of its messages. One that does not account for every byte of the chunk is not
believed: then the chunk is walked through. A recorder writes a chunk every quarter of a second: they are joined until
they are worth the while, and as long as they overlap in time, and the next ones are decompressed meanwhile.
"""

import struct
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from functools import partial
from itertools import pairwise
from typing import BinaryIO, NamedTuple

import numpy as np
from rosbags.interfaces import Connection
from rosbags.rosbag2.errors import ReaderError
from rosbags.rosbag2.storage_mcap import DECOMPRESSORS, ChunkInfo, McapReader, decompress

from .unpack import UnpackError, allowed, unpack

# rosbags unpacks whatever is there and only then compares, also on opening a file without an index.
DECOMPRESSORS.update({name: partial(unpack, name) for name in DECOMPRESSORS})

_MESSAGE, _CHUNK, _MESSAGE_INDEX = 0x05, 0x06, 0x07
_RECORD = struct.Struct('<BQ')
"""Its kind, and the bytes that follow."""
_MESSAGE_HEAD = struct.Struct('<BQHIQQ')
"""Kind, bytes that follow, channel, sequence, time of receipt, time of sending."""
_LEAST = _MESSAGE_HEAD.size - _RECORD.size
"""Bytes that follow kind and length of a message without content."""
_INDEX_HEAD = struct.Struct('<BQHI')
"""Kind, bytes that follow, channel, bytes of the entries."""
_CHUNK_HEAD = struct.Struct('<BQQQQII')
"""Kind, bytes that follow, first and last time, bytes uncompressed, checksum, letters of the compression's name."""
WORTHWHILE = 1_500_000
"""Bytes of chunks, uncompressed, that are taken together."""
AT_MOST = 64_000_000
"""Likewise, of chunks that overlap: beyond, messages are added one by one."""
_ENTRY = np.dtype([('received_ns', '<u8'), ('offset', '<u8')])


class Block(NamedTuple):
    """Messages of one topic, in the order in which they were received."""

    connection: Connection
    received_ns: np.ndarray
    """(n,)"""
    content: bytes
    """Holds them."""
    starts: np.ndarray
    """(n,), where in ``content`` they begin"""
    sizes: np.ndarray
    """(n,), bytes"""


class _Found(NamedTuple):
    """Messages of a chunk, each an element of the arrays."""

    channels: np.ndarray
    received_ns: np.ndarray
    offsets: np.ndarray
    """Where the record of a message begins."""
    lengths: np.ndarray
    """Bytes that follow kind and length of the record."""


class OutOfOrder(Exception):
    """Messages of a topic are not in the order of their chunks."""


def check_sizes(storage: McapReader) -> None:
    """Refuse an open file whose index has a chunk that would take all memory.

    Raises:
        ReaderError: it has one; the message says where.
    """
    for chunk in storage.chunks:
        try:
            allowed('a chunk', chunk.uncompressed_size)
        except UnpackError as error:
            raise ReaderError(f'{error}, at byte {chunk.chunk_start_offset} of {storage.path}') from error


def read_blocks(storage: McapReader) -> Iterator[list[Block]]:
    """The blocks of each group of chunks of an open file, one a topic at the most.

    Raises:
        OutOfOrder: those of a topic were received before some of an earlier group.
        ReaderError: the file is damaged.
    """
    assert storage.bio
    connections = {connection.id: connection for connection in storage.connections}
    newest_ns: dict[int, int] = {}
    with closing(_ahead(storage.bio, list(_groups(storage.chunks)))) as joined:  # closed: its thread reads the file
        for content, found in joined:
            order = np.lexsort((found.received_ns, found.channels))
            channels, received_ns, offsets, lengths = (column[order] for column in found)
            received_ns = received_ns.astype(np.int64)
            bounds = [*np.flatnonzero(np.diff(channels, prepend=-1)), len(order)]
            blocks = []
            for first, last in pairwise(bounds):
                channel = int(channels[first])
                if channel not in connections:
                    continue
                if received_ns[first] < newest_ns.get(channel, 0):
                    raise OutOfOrder
                newest_ns[channel] = int(received_ns[last - 1])
                blocks.append(Block(connections[channel], received_ns[first:last], content,
                                    offsets[first:last] + _MESSAGE_HEAD.size, lengths[first:last] - _LEAST))
            yield blocks


def _groups(chunks: Sequence[ChunkInfo]) -> Iterator[list[ChunkInfo]]:
    """Chunks by time, in groups that do not overlap each other."""
    group: list[ChunkInfo] = []
    size, end = 0, 0
    for chunk in sorted(chunks, key=lambda chunk: (chunk.message_start_time, chunk.chunk_start_offset)):
        if group and (size >= AT_MOST or (size >= WORTHWHILE and chunk.message_start_time >= end)):
            yield group
            group, size = [], 0
        group.append(chunk)
        size, end = size + chunk.uncompressed_size, max(end, chunk.message_end_time)
    if group:
        yield group


def _ahead(file: BinaryIO, groups: Sequence[list[ChunkInfo]]) -> Generator[tuple[bytes, _Found], None, None]:
    """What groups hold, each read in another thread while the one before it is used."""
    with ThreadPoolExecutor(1) as reader:
        following = reader.submit(_joined, file, groups[0]) if groups else None
        for group in [*groups[1:], None]:
            if following is None:
                return
            current = following.result()
            following = reader.submit(_joined, file, group) if group else None
            yield current


def _joined(file: BinaryIO, group: Sequence[ChunkInfo]) -> tuple[bytes, _Found]:
    """The records of some chunks, one behind the other, and the messages in them."""
    contents, entries = zip(*(_read(file, chunk) for chunk in group), strict=True)
    content = contents[0] if len(group) == 1 else b''.join(contents)
    starts = np.cumsum([0, *map(len, contents[:-1])])
    return content, _indexed(content, entries, starts.tolist()) or _walked(content)


def _read(file: BinaryIO, chunk: ChunkInfo) -> tuple[bytes, bytes]:
    """The records of a chunk, and the index behind it."""
    file.seek(chunk.chunk_start_offset)
    raw = file.read(chunk.chunk_length + chunk.message_index_length)
    kind, _, _, _, size, checksum, letters = _CHUNK_HEAD.unpack_from(raw)
    start = _CHUNK_HEAD.size + letters + 8
    if kind != _CHUNK or len(raw) < chunk.chunk_length or start + chunk.compressed_size > chunk.chunk_length:
        raise ReaderError(f'there is no whole chunk at {chunk.chunk_start_offset}')
    try:
        content = decompress(raw[start:start + chunk.compressed_size], chunk.compression, size, checksum)
    except (ReaderError, UnpackError) as error:
        raise ReaderError(f'{error}, at byte {chunk.chunk_start_offset} of {file.name}') from error
    return content, raw[chunk.chunk_length:]


def _indexed(content: bytes, indices: Sequence[bytes], starts: Sequence[int]) -> _Found | None:
    """What the indices say of some chunks that are joined; None when it is not true of every byte.

    Args:
        starts: where in ``content`` the chunk of each index begins.
    """
    channels, parts, begins = [], [], []
    for index, start in zip(indices, starts, strict=True):
        at = 0
        while at + _INDEX_HEAD.size <= len(index):
            kind, length, channel, size = _INDEX_HEAD.unpack_from(index, at)
            if kind != _MESSAGE_INDEX or at + _RECORD.size + length > len(index) or length != size + 6 or size % 16:
                return None
            parts.append(np.frombuffer(index, _ENTRY, size // 16, at + _INDEX_HEAD.size))
            channels.append(channel)
            begins.append(start)
            at += _RECORD.size + length
    if not parts:
        return None
    entries, counts = np.concatenate(parts), list(map(len, parts))
    offsets = entries['offset'].astype(np.int64)
    if (offsets < 0).any():
        return None
    offsets += np.repeat(np.array(begins, np.int64), counts)
    if (offsets < 0).any() or (offsets + _MESSAGE_HEAD.size > len(content)).any():
        return None
    found = _Found(np.repeat(channels, counts), entries['received_ns'], offsets,
                   _numbers(content, '<u8', offsets + 1).astype(np.int64))
    agrees = ((_numbers(content, 'u1', offsets) == _MESSAGE)
              & (_numbers(content, '<u2', offsets + 9) == found.channels)
              & (_numbers(content, '<u8', offsets + 15) == found.received_ns)
              & (found.lengths >= _LEAST) & (found.lengths <= len(content)))
    return found if agrees.all() and _is_whole(content, found) else None


def _is_whole(content: bytes, found: _Found) -> bool:
    """Whether a chunk has no messages beside those found, and they do not overlap."""
    order = np.argsort(found.offsets)
    starts = found.offsets[order]
    ends = starts + _RECORD.size + found.lengths[order]
    before, after = np.concatenate(([0], ends)), np.concatenate((starts, [len(content)]))
    return bool((before <= after).all()) and all(
        kind != _MESSAGE for gap in np.flatnonzero(before < after)
        for kind, _, _ in _records(content, int(before[gap]), int(after[gap])))


def _walked(content: bytes) -> _Found:
    """What a chunk holds, found from one record to the next."""
    rows = []
    for kind, at, length in _records(content, 0, len(content)):
        if kind == _MESSAGE:
            if length < _LEAST:
                raise ReaderError(f'a message has {length} bytes')
            _, _, channel, _, received_ns, _ = _MESSAGE_HEAD.unpack_from(content, at)
            rows.append((channel, received_ns, at, length))
    return _Found(*np.array(rows, np.int64).reshape(-1, 4).T)


def _records(content: bytes, start: int, end: int) -> Iterator[tuple[int, int, int]]:
    """Kind, place, and bytes that follow of the records in a part of a chunk, which must be whole."""
    while start < end:
        if start + _RECORD.size > end:
            raise ReaderError('a chunk ends within a record')
        kind, length = _RECORD.unpack_from(content, start)
        if start + _RECORD.size + length > end:
            raise ReaderError('a record is longer than its chunk')
        yield kind, start, length
        start += _RECORD.size + length


def _numbers(content: bytes, kind: str, places: np.ndarray) -> np.ndarray:
    """Numbers of a kind that begin at some places."""
    return windows(content, np.dtype(kind))[places]


def windows(content: bytes, kind: np.dtype) -> np.ndarray:
    """What ``content`` has at each of its bytes, read as ``kind``."""
    return np.ndarray(max(len(content) - kind.itemsize + 1, 0), kind, content, strides=(1,))
