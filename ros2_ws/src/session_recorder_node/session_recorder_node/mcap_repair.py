"""Giving an MCAP file that its writer could not finish the end that it lacks.

A writer that is killed leaves a record cut off in the middle and no index at the end. Everything before that is
whole, so the file is not copied: the torn end is cut off and the missing end is written in its place. Should this be
interrupted as well, it can be done again.
"""

import os
import struct
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Metadata, MetadataIndex, Schema
from mcap.stream_reader import CRCValidationError, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from .bag_folder import BagError, lock
from .mcap_content import RECORD_HEAD, ChunkInfo, Content, MessageTimes


def finish(path: Path, annotation: tuple[str, dict[str, str]] | None = None) -> tuple[int, int]:
    """Finish a file in place; one without a single whole chunk is removed.

    Args:
        annotation: name and content of a metadata record to stand behind the messages, in place of an earlier one.

    Returns:
        How many messages it holds, and how many bytes of a torn end were cut off.

    Raises:
        BagError: the file is being written, or is no recording of this recorder; it is left as it is.
    """
    with path.open('r+b') as file:
        lock(file, path)
        size = path.stat().st_size
        content, whole = _scan(file, path, size)
        indexes = _mend_last_chunk(file, content)
        if not content.chunks:
            path.unlink()
            return 0, size
        _learn_channels(file, content)
        content.metadata = [record for record in content.metadata if record.offset < content.chunks[-1].end]
        file.seek(content.chunks[-1].end)
        file.truncate()
        file.write(indexes)
        if annotation is not None:
            file.write(content.annotate(file.tell(), *annotation))
        file.write(content.end(file.tell()))
        file.flush()
        os.fsync(file.fileno())
        return content.messages, size - whole


def _scan(file: IO[bytes], path: Path, size: int) -> tuple[Content, int]:
    """What a file holds, and where its last whole record ends."""
    if not MCAP0_MAGIC.startswith(file.read(len(MCAP0_MAGIC))):
        raise BagError(f'{path} is no MCAP file; move it away')
    content, end = Content(), file.tell()
    for opcode, start, body in _records(file, size):
        stream = ReadDataStream(BytesIO(body))
        length = RECORD_HEAD.size + len(body)
        if opcode == Opcode.CHUNK:
            content.chunks.append(ChunkInfo.of(Chunk.read(stream), start, length))
        elif opcode == Opcode.MESSAGE_INDEX and content.chunks:
            chunk = content.chunks[-1]
            channel, entries_size = struct.unpack_from('<HI', body)
            chunk.index.message_index_offsets[channel] = start
            chunk.index.message_index_length += length
            chunk.counts[channel] = entries_size // 16
        elif opcode == Opcode.METADATA:
            content.metadata.append(MetadataIndex(start, length, Metadata.read(stream).name))
        elif opcode in (Opcode.DATA_END, 0):  # an end that was not finished either; a file system's zeros
            break
        elif opcode != Opcode.HEADER:
            raise BagError(f'{path} has a record ({opcode:#x}) that this recorder does not write; it is left as it is')
        end = start + length
    return content, end


def _records(file: IO[bytes], size: int) -> Iterator[tuple[int, int, bytes]]:
    """Opcode, offset and body of every whole record from here on."""
    start = file.tell()
    while start + RECORD_HEAD.size <= size:
        opcode, length = RECORD_HEAD.unpack(file.read(RECORD_HEAD.size))
        if start + RECORD_HEAD.size + length > size:
            return
        yield opcode, start, file.read(length)
        start += RECORD_HEAD.size + length


def _mend_last_chunk(file: IO[bytes], content: Content) -> bytes:
    """Drop a last chunk that is spoilt; gives the last good one's message indexes anew, as some may be missing."""
    while content.chunks:
        chunk = content.chunks[-1]
        try:
            return chunk.index_messages(_read_chunk(file, chunk, content))
        except (CRCValidationError, ZstdError):
            content.chunks.pop()
    return b''


def _learn_channels(file: IO[bytes], content: Content) -> None:
    """Schemas and channels stand in the chunk in which they were first used."""
    for chunk in content.chunks:
        if not content.channels.keys() >= chunk.counts.keys():
            _read_chunk(file, chunk, content)


def _read_chunk(file: IO[bytes], chunk: ChunkInfo, content: Content) -> MessageTimes:
    """Learn the schemas and channels of a chunk; gives the times and offsets of its messages."""
    file.seek(chunk.index.chunk_start_offset + RECORD_HEAD.size)
    data, size = get_chunk_data_stream(Chunk.read(ReadDataStream(file)), validate_crc=True)
    times: MessageTimes = {}
    for opcode, start, body in _records(BytesIO(data.read(size)), size):
        stream = ReadDataStream(BytesIO(body))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(stream)
            content.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream)
            content.channels[channel.id] = channel
        elif opcode == Opcode.MESSAGE:
            channel_id, _, received = struct.unpack_from('<HIQ', body)
            times.setdefault(channel_id, []).extend((received, start))
    return times
