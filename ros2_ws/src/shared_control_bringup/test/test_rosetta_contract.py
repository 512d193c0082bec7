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

"""``bags/rosetta_contract.yaml`` is what Rosetta asks for, and names what our graph publishes.

The schema is that of Rosetta's ``contract/schema.py`` and ``model.py`` at its commit dfd07e4 (August 2026), as far as
the file uses it; Rosetta's own loader takes the file as well (docs/how_to/bags.md).
"""

import importlib
from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, Literal

import numpy as np
import pytest
import yaml
from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError
from shared_control.contract import TOPICS
from shared_control_ros.contract import ros_topic

FILE = Path(__file__).parents[1] / 'bags' / 'rosetta_contract.yaml'
Text = Annotated[str, StringConstraints(min_length=1)]
Codec = Annotated[str, StringConstraints(pattern=r'^[\w.]+:\w+$')]


class Strict(BaseModel):
    """Unknown keys are errors, as they are to Rosetta."""

    model_config = ConfigDict(extra='forbid', strict=True)


class Qos(Strict):
    reliability: Literal['reliable', 'best_effort']
    history: Literal['keep_last']
    depth: Annotated[int, Field(gt=0)]
    durability: Literal['volatile', 'transient_local'] = 'volatile'


class BareChannel(Strict):
    topic: Text
    type: Text
    qos: Qos | None = None


class Channel(BareChannel):
    dtype: Literal['float32', 'float64', 'int32', 'int64', 'bool', 'string'] | None = None
    decoder: Codec | None = None


class ActionChannel(Channel):
    encoder: Codec | None = None
    safety: Literal['none', 'hold', 'zeros'] = 'none'


class RecordedChannel(Channel):
    dtype: Literal['float32', 'float64', 'int32', 'int64', 'bool', 'string']


class Align(Strict):
    strategy: Literal['hold', 'drop']
    timeline: Literal['header', 'receive']


class Observed(Strict):
    channel: Channel
    align: Align
    select: Annotated[list[Text], Field(min_length=1)] | None = None


class Action(Observed):
    channel: ActionChannel


class Recorded(Observed):
    channel: RecordedChannel


class Adjunct(Strict):
    channel: BareChannel


class RosettaContract(Strict):
    robot_type: Text
    robot_interface: Literal['ros2']
    fps: Annotated[int, Field(gt=0)]
    observations: dict[str, list[Observed] | Observed]
    actions: dict[str, list[Action] | Action]
    rewards: dict[str, Recorded] = {}
    signals: dict[str, Recorded] = {}
    info: dict[str, Recorded] = {}
    complementary_data: dict[str, Recorded] = {}
    adjunct: list[Adjunct] = []


CONTENT = yaml.safe_load(FILE.read_text())
CONTRACT = RosettaContract.model_validate(CONTENT)
ENTRIES = [entry for section in (CONTRACT.observations, CONTRACT.actions, CONTRACT.info, CONTRACT.complementary_data)
           for entries in section.values() for entry in (entries if isinstance(entries, list) else [entries])]
CHANNELS = [entry.channel for entry in (*ENTRIES, *CONTRACT.adjunct)]
OURS = {topic.full_name: topic for topic in TOPICS}


def message_of(channel):
    """A message with something to select from."""
    message = ros_topic(OURS[channel.topic]).msg_type()
    if channel.type == 'sensor_msgs/msg/JointState':
        message.name = [f'panda_joint{number}' for number in range(1, 8)]
    return message


@pytest.mark.parametrize('channel', CHANNELS, ids=lambda channel: channel.topic)
def test_a_channel_is_a_topic_of_ours(channel):
    topic = OURS[channel.topic]
    assert channel.type == topic.type
    if channel.qos is not None:
        assert channel.qos.depth == topic.depth
        assert (channel.qos.durability == 'transient_local') == topic.latched


@pytest.mark.parametrize('entry', ENTRIES, ids=lambda entry: entry.channel.topic)
def test_what_is_selected_is_in_its_messages(entry):
    message = message_of(entry.channel)
    assert (entry.align.timeline == 'header') == hasattr(message, 'header')
    assert len(set(entry.select or ())) == len(entry.select or ())
    for name in entry.select or ():
        field, _, rest = name.partition('.')
        if entry.channel.type == 'sensor_msgs/msg/JointState':
            assert hasattr(message, field) and rest in message.name
            continue
        value = message
        for part in name.split('.'):
            value = getattr(value, part)
        assert isinstance(value, float)


def test_a_wrench_there_and_back():
    entry = CONTRACT.actions['action']
    decode, encode = (getattr(importlib.import_module(path.partition(':')[0]), path.partition(':')[2])
                      for path in (entry.channel.decoder, entry.channel.encoder))
    spec = SimpleNamespace(names=entry.select)
    message = encode(np.array([1.5, -2.0]), spec, 12_000_000_034)
    assert (message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z) == (1.5, -2.0, 0.0)
    stamp = message.header.stamp
    assert (message.header.frame_id, stamp.sec, stamp.nanosec) == ('panda_link0', 12, 34)
    assert decode(message, spec).tolist() == [1.5, -2.0]


def test_one_key_each_of_numbers_since_rosetta_serves_no_more():
    assert len(CONTRACT.observations) == len(CONTRACT.actions) == 1


@pytest.mark.parametrize('spoil', [
    lambda content: content.pop('fps'), lambda content: content.update(surprise=1),
    lambda content: content['actions']['action'].pop('align'),
    lambda content: content['info']['phase']['channel'].pop('dtype')])
def test_the_schema_refuses_what_rosetta_refuses(spoil):
    spoiled = yaml.safe_load(FILE.read_text())
    spoil(spoiled)
    with pytest.raises(ValidationError):
        RosettaContract.model_validate(spoiled)
