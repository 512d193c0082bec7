"""``ros2 bag record`` with the files in bags/ records what session_recorder_node records."""

import re
from pathlib import Path

import pytest
import yaml
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.stream_reader import StreamReader
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from shared_control.contract import RECORDER_DEPTH
from shared_control.contract_tables import qos_overrides, record_arguments
from shared_control_records.bag.writer import BagWriter
from shared_control_ros.contract import BAG_TOPICS

PACKAGE = Path(__file__).parents[1]


@pytest.fixture
def recorded(tmp_path):
    """A file that the recorder has written."""
    bag = BagWriter(tmp_path / 'bag')
    channel = bag.add_topic('/training/phase', 'std_msgs/msg/String', 'string data\n', 'RIHS01_', '[]')
    bag.write(channel, b'\0\1\0\0\1\0\0\0\0', 1, 2, 1)
    bag.finish()
    return tmp_path / 'bag' / 'bag_0.mcap'


def test_overrides_are_the_recorders_subscriptions():
    text = (PACKAGE / 'bags' / 'qos_overrides.yaml').read_text()
    assert text == qos_overrides(), 'python -m shared_control.contract_tables qos_overrides'
    for topic, override in zip(BAG_TOPICS, yaml.safe_load(text).values(), strict=True):
        asked = QoSProfile(
            history=HistoryPolicy.get_from_short_key(override['history']), depth=override['depth'],
            reliability=ReliabilityPolicy.get_from_short_key(override['reliability']),
            durability=DurabilityPolicy.get_from_short_key(override['durability']))
        assert asked == QoSProfile(
            depth=RECORDER_DEPTH, reliability=topic.qos.reliability, durability=topic.qos.durability)


def test_storage_options_are_those_of_the_recorders_files(recorded):
    options = yaml.safe_load((PACKAGE / 'bags' / 'mcap_writer_options.yaml').read_text())
    with recorded.open('rb') as file:
        chunk = next(r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk))
        file.seek(0)
        summary = make_reader(file).get_summary()
    assert chunk.compression == options['compression'].lower()
    assert (chunk.uncompressed_crc == 0) == options['noChunkCRC']
    assert bool(summary.chunk_indexes[0].message_index_offsets) is not options['noMessageIndex']
    assert bool(summary.channels) is not options['noSummary']


def test_the_documented_command_names_all_topics_and_files():
    readme = (PACKAGE / 'README.md').read_text()
    command = re.search(r'ros2 bag record (.*?)(?:\n\n|\Z)', readme, re.DOTALL).group(1).replace('\\\n', ' ').split()
    assert record_arguments() in readme, 'python -m shared_control.contract_tables record_arguments'
    assert '--include-unpublished-topics' in command
    for option in ('--qos-profile-overrides-path', '--storage-config-file'):
        assert (PACKAGE / 'bags' / Path(command[command.index(option) + 1]).name).is_file()
