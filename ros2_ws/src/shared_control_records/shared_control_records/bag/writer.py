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

"""Writing an MCAP bag that rosbag2 reads and that survives the death of its writer."""

import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from mcap.writer import Writer

from .files import LIBRARY, BagError, bag_files, lock, next_file
from .metadata import blank_metadata, write_metadata
from .repair import Recovered, recover


class BagWriter:
    """Writes the next file of a bag.

    Messages collect in memory until :meth:`flush` writes them as one chunk, which then survives whatever becomes of
    this process. What an earlier writer of this project left unfinished is finished first.

    Args:
        bag: the bag's folder; made when it is missing.
        meanwhile: called again and again while an unfinished file is finished, as by :func:`recover`.

    Raises:
        BagError: the folder cannot be written, or another process is recording into it.
    """

    def __init__(self, bag: str | Path, meanwhile: Callable[[], None] = lambda: None):
        self.bag = Path(bag).expanduser().absolute()
        try:
            self.bag.mkdir(parents=True, exist_ok=True)
            self.recovered: list[Recovered] = recover(self.bag, meanwhile, own_only=True)
            self.previous_files = bag_files(self.bag)
            self.path = next_file(self.bag)
            self._file = self.path.open('xb')
        except BagError:
            raise
        except OSError as error:
            raise BagError(f'cannot record into {self.bag}: {error.strerror}') from error
        lock(self._file, self.path)
        self._open = True
        # Only flush() ends a chunk, never its size: so add_topic() and write() touch no disk and cannot fail.
        self._writer = Writer(self._file, chunk_size=sys.maxsize)
        self._schemas: dict[str, int] = {}
        self.messages = 0
        self.bytes = 0
        """What has been flushed."""
        try:
            self._writer.start(profile='ros2', library=LIBRARY)
            self._writer.add_metadata('rosbag2', {'serialized_metadata': blank_metadata()})
            self._writer.flush()
        except OSError as error:
            raise self._failed(error) from error

    def add_topic(self, name: str, type_name: str, definition: str, type_hash: str, qos: str) -> int:
        """Announce a topic before its first message.

        Args:
            name: the topic.
            type_name: as in ``sensor_msgs/msg/JointState``.
            definition: of the type and all types it is made of (encoding ``ros2msg``).
            type_hash: ``RIHS01_...``.
            qos: the QoS profiles offered, as YAML.

        Returns:
            The channel to write its messages to.
        """
        if type_name not in self._schemas:
            self._schemas[type_name] = self._writer.register_schema(type_name, 'ros2msg', definition.encode())
        return self._writer.register_channel(
            name, 'cdr', self._schemas[type_name], {'offered_qos_profiles': qos, 'topic_type_hash': type_hash})

    def write(self, channel: int, data: bytes, sent: int, received: int, sequence: int = 0) -> None:
        """Add one serialized message.

        Args:
            channel: from :meth:`add_topic`.
            sent, received: ns. A garbled packet names any time for ``sent``: one that rosbag2 cannot hold becomes that
                of receipt. Before 1970 it is 1970.
            sequence: the publisher's own count of its messages.
        """
        received = max(received, 0)
        self._writer.add_message(
            channel, log_time=received, data=data, publish_time=sent if 0 <= sent < 2**63 else received,
            sequence=sequence & 0xffffffff)
        self.messages += 1

    def flush(self) -> None:
        """Hand what has collected to the operating system; from then on it survives this process.

        Raises:
            BagError: it cannot be written; what was flushed before is kept.
        """
        try:
            self._writer.flush()
        except OSError as error:
            raise self._failed(error) from error
        self.bytes = self._file.tell()

    def finish(self) -> None:
        """Write the index and ``metadata.yaml``. Nothing happens when that is done already, or writing has failed.

        Raises:
            BagError: they cannot be written; what was flushed before is kept.
        """
        if not self._open:
            return
        try:
            self._writer.finish()
            self._file.close()
            self._open = False
            write_metadata(self.bag)
        except OSError as error:
            raise self._failed(error) from error

    def _failed(self, error: OSError) -> BagError:
        """Give the file up, keeping what has reached it; gives the error to raise."""
        self._open = False
        with suppress(OSError):
            self._file.close()
        return BagError(f'cannot write {self.path}: {error.strerror}; what was recorded before is kept: '
                        'once there is room, shared_control_records.bag.recover finishes it')
