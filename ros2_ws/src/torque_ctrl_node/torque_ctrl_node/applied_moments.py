"""What the controller used: the sum of the moments, and what each source put into it."""

from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from shared_control_ros.wrenches import base_wrench, set_moment


class AppliedMoments:
    """Publishes /target_wrench, /human/applied_wrench and /agent/applied_wrench with one stamp.

    Args:
        node: the controller's node.
    """

    def __init__(self, node: Node):
        self._publishers = [
            node.create_publisher(topic.msg_type, topic.name, topic.qos)
            for topic in (contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED)]
        self._wrench = base_wrench()
        self._moments = (0.0, 0.0, 0.0)

    @property
    def m_y(self) -> float:
        """The sum that was published last, N m."""
        return self._moments[0]

    def publish(self, stamp_ns: int, m_y: float, human: float, agent: float, is_due: bool) -> None:
        """Publish the sum and its parts, N m, if one of them has changed or ``is_due``."""
        moments = (m_y, human, agent)
        if moments == self._moments and not is_due:
            return
        self._moments = moments
        set_ns(self._wrench.header.stamp, stamp_ns)
        for publisher, moment in zip(self._publishers, moments, strict=True):
            set_moment(self._wrench, moment)
            publisher.publish(self._wrench)
