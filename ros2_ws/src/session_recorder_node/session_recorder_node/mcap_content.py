"""What an MCAP file holds, and the index at its end that says so.

An MCAP file is a row of records: here a header, a metadata record, and then chunks of messages, each followed by its
message indexes. The end of the file repeats schemas and channels and says where each chunk lies.
"""

import struct
from collections import Counter
from dataclasses import dataclass, field

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)
from mcap.writer import MCAP0_MAGIC

RECORD_HEAD = struct.Struct('<BQ')
"""Opcode of a record and length of what follows."""
_MESSAGE_INDEX_HEAD = struct.Struct('<BQHI')

MessageTimes = dict[int, list[int]]
"""By channel, in turn for each message: when it came (ns), and where in the chunk it lies."""


@dataclass
class ChunkInfo:
    """Where a chunk lies, and how many messages of each channel it holds."""

    index: ChunkIndex
    counts: Counter[int] = field(default_factory=Counter)

    @property
    def end(self) -> int:
        """Where the chunk ends and its message indexes begin."""
        return self.index.chunk_start_offset + self.index.chunk_length

    @classmethod
    def of(cls, chunk: Chunk, start: int, length: int) -> 'ChunkInfo':
        """Describe a chunk whose record starts at ``start`` and is ``length`` bytes long."""
        return cls(ChunkIndex(
            chunk_length=length, chunk_start_offset=start, compression=chunk.compression,
            compressed_size=len(chunk.data), message_end_time=chunk.message_end_time, message_index_length=0,
            message_index_offsets={}, message_start_time=chunk.message_start_time,
            uncompressed_size=chunk.uncompressed_size))

    def index_messages(self, times: MessageTimes) -> bytes:
        """The message indexes, to be written right behind the chunk; remembers where they will lie."""
        builder = RecordBuilder()
        self.index.message_index_offsets.clear()
        for channel, entries in times.items():
            self.index.message_index_offsets[channel] = self.end + builder.count
            size = 8 * len(entries)
            builder.write(_MESSAGE_INDEX_HEAD.pack(Opcode.MESSAGE_INDEX, 6 + size, channel, size))
            builder.write(struct.pack(f'<{len(entries)}Q', *entries))
        self.index.message_index_length = builder.count
        self.counts = Counter({channel: len(entries) // 2 for channel, entries in times.items()})
        return builder.end()


@dataclass
class Content:
    """What a file holds."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: list[ChunkInfo] = field(default_factory=list)
    metadata: list[MetadataIndex] = field(default_factory=list)

    @property
    def messages(self) -> int:
        """How many messages all chunks hold."""
        return self._statistics().message_count

    def start(self, metadata: dict[str, str]) -> bytes:
        """The first bytes of a file of ROS 2 messages, with a metadata record as rosbag2 puts there."""
        builder = RecordBuilder()
        builder.write(MCAP0_MAGIC)
        Header(profile='ros2', library='session_recorder_node').write(builder)
        builder.write(self.annotate(builder.count, 'rosbag2', metadata))
        return builder.end()

    def annotate(self, offset: int, name: str, metadata: dict[str, str]) -> bytes:
        """A metadata record, to be written at ``offset``; remembers where it will lie."""
        builder = RecordBuilder()
        Metadata(name=name, metadata=metadata).write(builder)
        self.metadata.append(MetadataIndex(offset, builder.count, name))
        return builder.end()

    def end(self, offset: int) -> bytes:
        """The last bytes of the file, to be written at ``offset`` behind the last chunk and its indexes."""
        builder = RecordBuilder()
        DataEnd(0).write(builder)
        summary_start = offset + builder.count
        for records in (self.schemas.values(), self.channels.values(), [self._statistics()],
                        [chunk.index for chunk in self.chunks], self.metadata):
            for record in records:
                record.write(builder)
        Footer(summary_start=summary_start, summary_offset_start=0, summary_crc=0).write(builder)
        builder.write(MCAP0_MAGIC)
        return builder.end()

    def _statistics(self) -> Statistics:
        counts: Counter[int] = Counter()
        for chunk in self.chunks:
            counts.update(chunk.counts)
        return Statistics(
            attachment_count=0, channel_count=len(self.channels), channel_message_counts=dict(counts),
            chunk_count=len(self.chunks), message_count=counts.total(),
            message_start_time=min((chunk.index.message_start_time for chunk in self.chunks), default=0),
            message_end_time=max((chunk.index.message_end_time for chunk in self.chunks), default=0),
            metadata_count=len(self.metadata), schema_count=len(self.schemas))
