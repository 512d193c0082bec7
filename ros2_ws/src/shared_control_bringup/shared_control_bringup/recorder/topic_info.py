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

"""What a bag says of a topic, so that it can be read and played without the packages of this workspace."""

from dataclasses import dataclass
from functools import cache

import yaml
from rclpy.qos import QoSProfile
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore


@dataclass(frozen=True)
class MessageType:
    """A ROS message type as a bag describes it."""

    name: str
    """As in ``sensor_msgs/msg/JointState``."""
    definition: str
    """The definition and those of all types it is made of (encoding ``ros2msg``)."""
    type_hash: str
    """``RIHS01_...``, the same on every Jazzy machine."""


def message_type(msg_class: type) -> MessageType:
    """Describe an rclpy message class of the standard packages of Jazzy."""
    name = f'{msg_class.__module__.split(".")[0]}/msg/{msg_class.__name__}'
    store = _typestore()
    return MessageType(name, store.generate_msgdef(name, ros_version=2)[0], store.hash_rihs01(name))


def qos_yaml(qos: QoSProfile) -> str:
    """The ``offered_qos_profiles`` of a topic, in the form in which rosbag2 reads it back.

    Deadline, lifespan and liveliness, which the contract leaves open, appear as a Jazzy publisher offers them.
    """
    return yaml.safe_dump([{
        'history': qos.history.name.lower(),
        'depth': qos.depth,
        'reliability': qos.reliability.name.lower(),
        'durability': qos.durability.name.lower(),
        'deadline': _infinite(),
        'lifespan': _infinite(),
        'liveliness': 'automatic',
        'liveliness_lease_duration': _infinite(),
        'avoid_ros_namespace_conventions': False,
    }], sort_keys=False)


def _infinite() -> dict[str, int]:
    return {'sec': 9223372036, 'nsec': 854775807}


@cache
def _typestore() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)
