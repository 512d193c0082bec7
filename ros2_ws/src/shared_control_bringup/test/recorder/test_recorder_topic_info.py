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
