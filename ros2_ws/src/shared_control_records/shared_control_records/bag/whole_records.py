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

"""The records of an MCAP file up to where its writer was killed.

A killed writer leaves one record that is cut off, at the end. A damaged file may look alike: a flipped bit in the
length of a record makes it reach beyond the end. What tells them apart is that whole records follow the damage.
"""

import mmap
import struct
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import IO

from mcap.data_stream import RecordBuilder
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk, McapRecord, Message
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from .files import BagError

_HEAD = struct.Struct('<BQ')
"""Kind of a record, and the bytes that follow."""
UNREADABLE = (McapError, ValueError, struct.error, OverflowError, MemoryError, ZstdError, RuntimeError)
"""Which of them, depends on where a record is damaged; lz4 raises RuntimeError."""
_IN_A_ROW = 3
"""Where so many messages follow each other, it is no chance."""


def whole_records(source: IO[bytes], path: Path) -> Iterator[McapRecord]:
    """The records behind the file's first bytes, chunks as a whole, up to the end or to one that is cut off.

    Raises:
        BagError: one before the end is damaged.
    """
    if not source.seek(0, 2):
        return  # an empty file cannot be mapped
    has_messages = False
    with mmap.mmap(source.fileno(), 0, access=mmap.ACCESS_READ) as content:
        at = len(MCAP0_MAGIC)
        while at < len(content):
            record, end = _record(content, at)
            if record is None:
                if _any_follows(content, at + 1, has_messages):
                    raise damaged(path, at)
                return
            has_messages = has_messages or isinstance(record, Message)
            source.seek(end)  # where who reads this is, too
            yield record
            at = end


def damaged(path: Path, at: int) -> BagError:
    """What is said of a file that is damaged at byte ``at``, before its end."""
    return BagError(f'{path} is damaged before its end (about byte {at}); it is left as it is, move it away')


def _record(content: mmap.mmap, at: int) -> tuple[McapRecord | None, int]:
    """The record that begins at a byte, and where it ends; None when there is no whole one."""
    if at + _HEAD.size > len(content):
        return None, at
    _, length = _HEAD.unpack_from(content, at)
    end = at + _HEAD.size + length
    if end > len(content):
        return None, at
    try:
        record = next(StreamReader(BytesIO(content[at:end]), skip_magic=True, emit_chunks=True).records)
    except (*UNREADABLE, StopIteration):
        return None, at
    # The reader passes over what a record is too long by: with a wrong length, those that follow.
    rewritten = RecordBuilder()
    record.write(rewritten)
    return (record, end) if rewritten.count == end - at else (None, at)


def _any_follows(content: mmap.mmap, start: int, has_messages: bool) -> bool:
    """Whether a whole chunk begins somewhere behind a byte; in a file without chunks: whether messages do."""
    return any(_is_chunk(content, at) for at in _places(content, Opcode.CHUNK, start)) or (
        has_messages and any(_are_messages(content, at) for at in _places(content, Opcode.MESSAGE, start)))


def _places(content: mmap.mmap, kind: int, start: int) -> Iterator[int]:
    """Where a record of a kind that ends before the file does may begin."""
    while (start := content.find(bytes([kind]), start)) >= 0:
        if start + _HEAD.size <= len(content):
            _, length = _HEAD.unpack_from(content, start)
            if start + _HEAD.size + length <= len(content):
                yield start
        start += 1


def _is_chunk(content: mmap.mmap, at: int) -> bool:
    record, _ = _record(content, at)
    try:
        return isinstance(record, Chunk) and bool(breakup_chunk(record, validate_crc=True))
    except UNREADABLE:
        return False


def _are_messages(content: mmap.mmap, at: int) -> bool:
    for _ in range(_IN_A_ROW):
        record, at = _record(content, at)
        if not isinstance(record, Message):
            return False
    return True
