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

"""A bag's ``metadata.yaml``, made from the files that it describes (version 9, as rosbag2 of Jazzy writes it)."""

import os
import struct
from pathlib import Path
from typing import Any

import yaml
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from .files import LIBRARY, BagError, bag_files

_INFORMATION = 'rosbag2_bagfile_information'
_STORAGES = ('.mcap', '.mcap.zstd', '.db3', '.db3.zstd')
"""How the names of files end that rosbag2 records."""
_NEVER = 2 ** 63 - 1
"""What rosbag2 gives as the start of a file without a message, ns."""


def blank_metadata() -> str:
    """What rosbag2 puts at the head of an MCAP file: it tells a reader the version in which the file is written."""
    return _dump(_describe([]))


def read_summary(path: Path) -> Summary | None:
    """The index at the end of an MCAP file, or None when the file was left unfinished.

    It has no list of chunks: a recorder reads the index of every file whenever it begins a new one, and the lists of an
    hour take 10 MB.

    Raises:
        BagError: the file has an end, and is damaged.
    """
    if not is_finished(path):
        return None
    with path.open('rb') as file:
        try:
            summary = make_reader(file).get_summary()
        except Exception as error:  # mcap raises errors of many kinds
            raise BagError(f'{path} is damaged: {error}; it is left as it is, move it away') from error
    if summary is not None:
        summary.chunk_indexes.clear()
    return summary


def is_finished(path: Path) -> bool:
    """Whether an MCAP file has its end, and so its index."""
    with path.open('rb') as file:
        file.seek(max(len(MCAP0_MAGIC), path.stat().st_size - len(MCAP0_MAGIC)))
        return file.read() == MCAP0_MAGIC


def recorder_of(path: Path) -> str | None:
    """What an MCAP file says has written it; empty when it is none, None when it ends before that."""
    with path.open('rb') as file:
        try:
            return make_reader(file).get_header().library
        except (EndOfFile, struct.error):
            return None
        except Exception:  # mcap raises errors of many kinds
            return ''


def refuse_another_recorder(bag: Path) -> None:
    """Refuse to record into a folder with a bag that another recorder has written, or is writing.

    Raises:
        BagError: there is one; the message says what to do.
        OSError: a file cannot be read.
    """
    recorded = [path for path in sorted(bag.glob('*')) if path.name.endswith(_STORAGES)]
    others = [path for path in recorded if path.suffix != '.mcap' or recorder_of(path) not in (LIBRARY, None)]
    described = bag / 'metadata.yaml'
    if described.exists() and not recorded:
        others = [described]  # of files in a storage that is not known here
    if others:
        raise BagError(f'{others[0]} is of another recorder, which may still be writing: record into another folder, '
                       'or move away what is there')


def unlisted_files(bag: Path) -> list[Path]:
    """The files of a bag that its ``metadata.yaml`` does not name, so that nobody reads them; all without one.

    One that is compressed may have been unpacked beside it, as ``ros2 bag play`` does.

    Raises:
        BagError: that is no metadata of a bag.
    """
    path = bag / 'metadata.yaml'
    if not path.exists():
        return bag_files(bag)
    try:
        listed = yaml.safe_load(path.read_text(encoding='utf-8'))[_INFORMATION]['relative_file_paths']
        named = {Path(name).name.removesuffix('.zstd') for name in listed}
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        raise BagError(f'{path} is no metadata of a bag; move it away') from error
    return [file for file in bag_files(bag) if file.name not in named]


def write_metadata(bag: Path) -> None:
    """Write ``metadata.yaml`` for the finished files of a bag; an unfinished one is left out until it is finished.

    What somebody has added to it stays.
    """
    summaries = [(path.name, read_summary(path)) for path in bag_files(bag)]
    finished = [(name, summary) for name, summary in summaries if summary is not None]
    target = bag / 'metadata.yaml'
    earlier = _read(target)
    known = earlier.get(_INFORMATION)
    known = known if isinstance(known, dict) else {}
    described = {**known, **_describe(finished), 'custom_data': known.get('custom_data')}
    unfinished = target.with_suffix('.yaml.tmp')
    unfinished.write_text(_dump({**earlier, _INFORMATION: described}), encoding='utf-8')
    unfinished.replace(target)


def _read(path: Path) -> dict[str, Any]:
    """The content of a YAML file; empty when there is none, or none that can be read."""
    try:
        content = yaml.safe_load(path.read_text(encoding='utf-8'))
    except (FileNotFoundError, yaml.YAMLError, ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


def _describe(files: list[tuple[str, Summary]]) -> dict[str, Any]:
    """The content of ``metadata.yaml`` for these files."""
    spans = [_span(summary) for _, summary in files]
    start = min((first for first, _ in spans), default=_NEVER)
    end = max((last for first, last in spans if first != _NEVER), default=start)
    return {
        'version': 9,
        'storage_identifier': 'mcap',
        'duration': {'nanoseconds': end - start},
        'starting_time': {'nanoseconds_since_epoch': start},
        'message_count': sum(_count(summary) for _, summary in files),
        'topics_with_message_count': _topics([summary for _, summary in files]),
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [name for name, _ in files],
        'files': [{
            'path': name,
            'starting_time': {'nanoseconds_since_epoch': first},
            'duration': {'nanoseconds': last - first},
            'message_count': _count(summary),
        } for (name, summary), (first, last) in zip(files, spans, strict=True)],
        'custom_data': None,
        'ros_distro': os.environ.get('ROS_DISTRO', 'jazzy'),
    }


def _topics(summaries: list[Summary]) -> list[dict[str, Any]]:
    """Every topic of the files once, with the sum of its messages."""
    topics: dict[str, dict[str, Any]] = {}
    for summary in summaries:
        for channel in summary.channels.values():
            schema = summary.schemas.get(channel.schema_id)  # messages that describe themselves have none
            topic = topics.setdefault(channel.topic, {
                'topic_metadata': {
                    'name': channel.topic,
                    'type': schema.name if schema else '',
                    'serialization_format': channel.message_encoding,
                    'offered_qos_profiles': yaml.safe_load(channel.metadata.get('offered_qos_profiles', '')) or [],
                    'type_description_hash': channel.metadata.get('topic_type_hash', ''),
                },
                'message_count': 0,
            })
            if summary.statistics is not None:
                topic['message_count'] += summary.statistics.channel_message_counts.get(channel.id, 0)
    return list(topics.values())


def _count(summary: Summary) -> int:
    return summary.statistics.message_count if summary.statistics else 0


def _span(summary: Summary) -> tuple[int, int]:
    """When the first and the last message of a file came, ns."""
    if summary.statistics is None or not summary.statistics.message_count:
        return _NEVER, _NEVER
    return summary.statistics.message_start_time, summary.statistics.message_end_time


def _dump(content: dict[str, Any]) -> str:
    return yaml.safe_dump(content, sort_keys=False)
