"""What a bag says of a topic, against what ROS itself says."""

import json
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from shared_control_bringup.recorder.topic_info import message_type
from shared_control_ros import contract


@pytest.mark.parametrize('msg_class', sorted({topic.msg_type for topic in contract.TOPICS}, key=str))
def test_hash_and_definition_are_those_of_ros(msg_class):
    described = message_type(msg_class)
    assert described.type_hash == hash_of_ros(msg_class, described.name)
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(described.definition, described.name))
    assert store.hash_rihs01(described.name) == described.type_hash


def hash_of_ros(msg_class, name):
    """As the package that brings the message has it on disk."""
    package, _, message = name.split('/')
    for folder in Path(__import__(package).__file__).parents:
        path = folder / 'share' / package / 'msg' / f'{message}.json'
        if path.exists():
            hashes = json.loads(path.read_text())['type_hashes']
            return next(entry['hash_string'] for entry in hashes if entry['type_name'] == name)
    pytest.fail(f'{package} brings no {message}.json')
