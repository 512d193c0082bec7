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

"""``ros2 bag record`` with the files in bags/ records what session_recorder_node records."""

import re
from pathlib import Path

import pytest
import yaml
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.stream_reader import StreamReader
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from shared_control import contract as table
from shared_control.contract import RECORDER_DEPTH
from shared_control.contract_tables import qos_overrides, record_arguments
from shared_control_records.bag.writer import BagWriter
from shared_control_ros.contract import BAG_TOPICS, ros_topic
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.watching.observer import Observer
from shared_control_ros.watching.scene import Scene
from shared_control_testing import sessions as made

PACKAGE = Path(__file__).parents[1]
README = (PACKAGE / 'README.md').read_text()


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


def documented(verb):
    """The words of the README's command ``ros2 bag VERB``."""
    command = re.search(rf'    ros2 bag {verb} (.*?)(?:\n\n|\Z)', README, re.DOTALL)
    return command.group(1).replace('\\\n', ' ').split()


def test_the_documented_command_names_all_topics_and_files():
    command = documented('record')
    assert record_arguments() in README, 'python -m shared_control.contract_tables record_arguments'
    assert '--include-unpublished-topics' not in command, 'topics that subscribers announce are recorded without QoS'
    for option in ('--qos-profile-overrides-path', '--storage-config-file'):
        assert (PACKAGE / 'bags' / Path(command[command.index(option) + 1]).name).is_file()


def test_a_bag_played_as_documented_shows_arm_and_ball_and_latches_the_phase(observer):
    """The test plays as ``ros2 bag play`` does with these options; screens are the watchers that they are made of."""
    command = documented('play')
    remapped = dict([command[command.index('--remap') + 1].split(':=')])
    overrides = yaml.safe_load((PACKAGE / 'bags' / Path(
        command[command.index('--qos-profile-overrides-path') + 1]).name).read_text())
    topics = (table.JOINT_STATES, table.BALL, table.PHASE)
    publishers = {topic: observer.node.create_publisher(
        ros_topic(topic).msg_type, remapped.get(topic.full_name, topic.full_name),
        QoSProfile(depth=1, durability=DurabilityPolicy.get_from_short_key(overrides[topic.full_name]['durability'])))
        for topic in topics}
    recording = made.record([made.lesson(5)])
    watcher, scene = Observer(observer.node), Scene()

    def play(topic):
        for message in recording.of(topic):
            publishers[topic].publish(made.STORE.serialize_cdr(message, topic.type).tobytes())

    def shown():
        play(table.JOINT_STATES)
        play(table.BALL)
        watcher.update(scene)
        return scene.q is not None and scene.ball is not None

    play(table.PHASE)
    lesson = Lesson(observer.node)  # comes late
    observer.spin(shown)
    observer.spin(lambda: lesson.update() or lesson.phase == 'teach')


def test_the_launch_file_plays_as_documented():
    launch = (PACKAGE / 'launch' / 'replay.launch.py').read_text()
    for word in documented('play'):
        if word not in ('bag', '\\'):
            assert repr(Path(word).name if word.startswith('$share') else word) in launch
