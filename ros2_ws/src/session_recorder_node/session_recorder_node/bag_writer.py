"""Writing an MCAP bag that rosbag2 reads and that survives the death of its writer."""

from contextlib import suppress
from pathlib import Path

from rclpy.qos import QoSProfile

from .bag_folder import BagError, bag_files, lock, next_file
from .mcap_writer import McapWriter
from .metadata import blank_metadata, write_metadata
from .recovery import Recovered, recover
from .topic_info import message_type, qos_yaml


class BagWriter:
    """Writes the next file of a bag.

    Messages collect in memory until :meth:`flush` writes them as one chunk, which then survives whatever becomes of
    this process. What an earlier writer left unfinished is finished first.

    Args:
        bag: the bag's folder; made when it is missing.

    Raises:
        BagError: the folder cannot be written, or another process is recording into it.
    """

    def __init__(self, bag: str | Path):
        self.bag = Path(bag).expanduser().absolute()
        try:
            self.bag.mkdir(parents=True, exist_ok=True)
            self.recovered: list[Recovered] = recover(self.bag)
            self.previous_files = bag_files(self.bag)
            self.path = next_file(self.bag)
            self._file = self.path.open('xb')
        except BagError:
            raise
        except OSError as error:
            raise BagError(f'cannot record into {self.bag}: {error.strerror}') from error
        lock(self._file, self.path)
        self._open = True
        self._schemas: dict[str, int] = {}
        self.messages = 0
        self.bytes = 0
        """What has been flushed."""
        try:
            self._writer = McapWriter(self._file, {'serialized_metadata': blank_metadata()})
        except OSError as error:
            raise self._failed(error) from error

    def add_topic(self, name: str, msg_class: type, qos: QoSProfile) -> int:
        """Announce a topic before its first message; gives the channel to write it to."""
        described = message_type(msg_class)
        if described.name not in self._schemas:
            self._schemas[described.name] = self._writer.add_schema(described.name, described.definition)
        return self._writer.add_channel(name, self._schemas[described.name], {
            'offered_qos_profiles': qos_yaml(qos), 'topic_type_hash': described.type_hash})

    def write(self, channel: int, data: bytes, sent: int, received: int, sequence: int = 0) -> None:
        """Add one serialized message. Times in ns; ``sequence`` is the publisher's own count of its messages."""
        self._writer.add_message(channel, data, sent, received, sequence & 0xffffffff)
        self.messages += 1

    def flush(self) -> None:
        """Hand what has collected to the operating system; from then on it survives this process."""
        try:
            self._writer.flush()
        except OSError as error:
            raise self._failed(error) from error
        self.bytes = self._file.tell()

    def finish(self) -> None:
        """Write the index and ``metadata.yaml``. Nothing happens when that is done already."""
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
        kept = 'what was recorded before is in the bag'
        try:
            recover(self.bag)
        except OSError:
            kept = 'what was recorded before is kept: once there is room, session_recorder_node.recover finishes it'
        return BagError(f'cannot write {self.path}: {error.strerror}; {kept}')
