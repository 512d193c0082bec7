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

"""Writing a file of a bag anew from what is whole in it.

A writer that is killed leaves a record cut off in the middle and no index at the end. What is whole is copied, chunk
by chunk, into a file beside it, which takes its place once it is complete and on the disk. Whatever goes wrong before
that leaves the file as it was.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import IO

from mcap.records import Channel, Chunk, DataEnd, Header, McapRecord, Message, MessageIndex, Metadata, Schema
from mcap.stream_reader import breakup_chunk
from mcap.writer import MCAP0_MAGIC, Writer

from .files import BagError, lock
from .metadata import read_summary
from .unpack import SpoiltError, UnpackError
from .whole_records import UNREADABLE, damaged, whole_records


def rewrite(path: Path, annotation: tuple[str, dict[str, str]] | None = None,
            meanwhile: Callable[[], None] = lambda: None) -> tuple[int, int]:
    """Put a finished copy in the place of a file; one without a single whole chunk is removed.

    Args:
        annotation: name and content of a metadata record to stand behind the messages, in place of an earlier one.
            A file that gets one is kept even without a message.
        meanwhile: called after each chunk.

    Returns:
        How many messages it holds, and how many bytes of a torn end were cut off.

    Raises:
        BagError: the file is being written, is no recording of this recorder, or is damaged before its end.
        OSError: the copy cannot be written.
    """
    unfinished = path.with_name(f'{path.name}.tmp')
    with path.open('r+b') as source:  # network file systems lock only what is open for writing
        lock(source, path)
        if not MCAP0_MAGIC.startswith(source.read(len(MCAP0_MAGIC))):
            raise BagError(f'{path} is no MCAP file; move it away')
        source.seek(0)
        summary = read_summary(path)
        try:
            with unfinished.open('wb') as target:
                writer = Writer(target)
                try:
                    messages, end = _copy(source, path, writer, annotation[0] if annotation else None, meanwhile)
                except KeyError as error:  # a message of a channel that is not announced
                    raise damaged(path, source.tell()) from error
                if annotation:
                    writer.add_metadata(*annotation)
                writer.finish()
                target.flush()
                os.fsync(target.fileno())
            if summary and summary.statistics and summary.statistics.message_count != messages:
                raise BagError(f'{path} is damaged: only {messages} of {summary.statistics.message_count} messages '
                               'can be read; it is left as it is')
            if messages or annotation:
                unfinished.replace(path)
            else:
                path.unlink()
        finally:
            unfinished.unlink(missing_ok=True)
        return messages, os.fstat(source.fileno()).st_size - end


def _copy(source: IO[bytes], path: Path, writer: Writer, without: str | None,
          meanwhile: Callable[[], None]) -> tuple[int, int]:
    """Copy all but the metadata record ``without``; gives the number of messages and where the last of it ends."""
    schemas: dict[int, int] = {0: 0}  # none, of messages that describe themselves
    channels: dict[int, int] = {}
    messages = end = 0
    spoilt = False
    for record in whole_records(source, path):
        match record:
            case Header():
                writer.start(record.profile, record.library)
            case Metadata():
                if record.name != without:
                    writer.add_metadata(record.name, record.metadata)
            case Chunk():
                try:
                    content = breakup_chunk(record, validate_crc=True)
                except UNREADABLE as error:
                    if isinstance(error, UnpackError) and not isinstance(error, SpoiltError):
                        raise BagError(f'{path} is left as it is, move it away: {error}; it ends at byte '
                                       f'{source.tell()}') from error
                    spoilt = True
                    continue
                if spoilt:
                    raise damaged(path, end)
                messages += _copy_messages(content, writer, schemas, channels)
                writer.flush()  # chunks stay as they were
                meanwhile()
            case DataEnd():
                break
            case Schema() | Channel() | Message():  # a file without chunks, as `ros2 bag convert` can write it
                if spoilt:
                    raise damaged(path, end)
                messages += _copy_messages([record], writer, schemas, channels)
            case MessageIndex():
                pass
            case _:
                raise BagError(f'{path} has a {type(record).__name__} that this recorder does not write; '
                               'it is left as it is, move it away')
        if not spoilt:
            end = source.tell()
    return messages, end


def _copy_messages(content: list[McapRecord], writer: Writer, schemas: dict[int, int], channels: dict[int, int]) -> int:
    """Copy what a chunk holds; gives the number of messages. The dictionaries map its ids to those of the copy."""
    messages = 0
    for record in content:
        match record:
            case Message():
                writer.add_message(channels[record.channel_id], record.log_time, record.data, record.publish_time,
                                   record.sequence)
                messages += 1
            case Channel():
                channels[record.id] = writer.register_channel(
                    record.topic, record.message_encoding, schemas[record.schema_id], record.metadata)
            case Schema():
                schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
    return messages
