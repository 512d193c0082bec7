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

"""The contract for rclpy is the table of the core."""

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from shared_control import contract as table
from shared_control_ros import contract


def test_topics_have_the_types_and_the_qos_of_the_table():
    for topic, entry in zip(contract.TOPICS, table.TOPICS, strict=True):
        assert (topic.name, topic.full_name) == (entry.name, entry.full_name)
        package, folder, name = entry.type.split('/')
        assert topic.msg_type.__module__.startswith(f'{package}.{folder}.') and topic.msg_type.__name__ == name
        assert topic.qos.depth == entry.depth and topic.qos.reliability == ReliabilityPolicy.RELIABLE
        assert (topic.qos.durability == DurabilityPolicy.TRANSIENT_LOCAL) == entry.latched


def test_constants_are_the_topics_they_are_named_after():
    names = [name for name, value in vars(table).items() if isinstance(value, table.Topic)]
    assert len(names) == len(table.TOPICS)
    for name in names:
        assert getattr(contract, name) is contract.ros_topic(getattr(table, name))
