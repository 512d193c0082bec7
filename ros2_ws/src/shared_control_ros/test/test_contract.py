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
