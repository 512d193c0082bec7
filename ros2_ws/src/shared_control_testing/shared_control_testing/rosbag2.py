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

"""Bags as the tools of rosbag2 leave them, made from one of ours with ``mcap``.

What stands here was seen with rosbag2 0.26.5 (``ros2 bag record``, ``convert``, ``reindex``): names of files and
fields, what is kept of a session and what is not.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml
import zstandard
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema
from mcap.writer import Writer
from shared_control_records.bag.metadata import write_metadata

Entry = tuple[Schema, Channel, Message]
CHUNK_BYTES = 131_072


def entries(bag: Path) -> Iterator[Entry]:
    """All messages of a bag's files."""
    for path in sorted(bag.glob('*.mcap')):
        with path.open('rb') as file:
            for schema, channel, message in make_reader(file).iter_messages():
                assert schema is not None
                yield schema, channel, message


def convert(bag: Path, target: Path, files: int = 1, compression: str = '', chunks: bool = True, qos: bool = True,
            rename: Callable[[str], str] = str) -> Path:
    """As ``ros2 bag convert`` or ``ros2 bag record``: the messages alone, no sequence, no record of the session.

    Args:
        files: into how many it is split.
        compression: ``file``, ``message`` or none (beside the chunks').
        chunks: false: as the storage preset ``fastwrite``.
        qos: false: as ``ros2 bag record --include-unpublished-topics`` that was there before the publishers.
        rename: of topics.
    """
    target.mkdir()
    found = list(entries(bag))
    size = -(-len(found) // files)
    for number in range(files):
        _write(target / f'{target.name}_{number}.mcap', found[number * size:(number + 1) * size], chunks, qos,
               compression == 'message', rename)
    write_metadata(target)
    if compression:
        with edited(target / 'metadata.yaml') as content:
            content |= {'compression_format': 'zstd', 'compression_mode': compression.upper()}
            if compression == 'file':
                content['relative_file_paths'] = [_compressed(path).name for path in sorted(target.glob('*.mcap'))]
                for entry in content['files']:
                    entry['path'] += '.zstd'
    return target


def reindex(bag: Path) -> Path:
    """As ``ros2 bag reindex``: a ``metadata.yaml`` with the topics in another order and no list of files."""
    with edited(bag / 'metadata.yaml') as content:
        content['topics_with_message_count'].reverse()
        content['files'] = []
    return bag


@contextmanager
def edited(metadata: Path) -> Iterator[dict[str, Any]]:
    """The content of a ``metadata.yaml``, written back as it is left."""
    content = yaml.safe_load(metadata.read_text())
    yield content['rosbag2_bagfile_information']
    metadata.write_text(yaml.safe_dump(content))


def _write(path: Path, found: list[Entry], chunks: bool, qos: bool, compress: bool,
           rename: Callable[[str], str]) -> None:
    pack = zstandard.ZstdCompressor()
    with path.open('wb') as file:
        writer = Writer(file, chunk_size=CHUNK_BYTES, use_chunking=chunks)
        writer.start(profile='ros2', library='libmcap 1.3.0')
        writer.add_metadata('rosbag2', {'serialized_metadata': '{}'})
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}
        for schema, channel, message in found:
            if channel.topic not in channels:
                if schema.name not in schemas:
                    schemas[schema.name] = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(
                    rename(channel.topic), 'cdr', schemas[schema.name],
                    dict(channel.metadata) if qos else {'offered_qos_profiles': '', 'topic_type_hash': ''})
            data = pack.compress(message.data) if compress else message.data
            writer.add_message(channels[channel.topic], message.log_time, data, message.publish_time)
        writer.finish()


def _compressed(path: Path) -> Path:
    target = path.with_name(f'{path.name}.zstd')
    target.write_bytes(zstandard.ZstdCompressor().compress(path.read_bytes()))
    path.unlink()
    return target
