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

"""What the controller used: the sum of the moments, and what each source put into it."""

import numpy as np
from rclpy.node import Node
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from shared_control_ros.wrenches import base_wrench, set_moment


class AppliedMoments:
    """Publishes /target_wrench, /human/applied_wrench and /agent/applied_wrench with one stamp.

    Args:
        node: the controller's node.
        axes: of the task.
        frame: name of the base frame.
    """

    def __init__(self, node: Node, axes: tuple[int, ...], frame: str):
        self._axes = axes
        self._publishers = [
            node.create_publisher(topic.msg_type, topic.name, topic.qos)
            for topic in (contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED)]
        self._wrench = base_wrench(frame)
        self._moments = np.zeros((len(self._publishers), len(axes)))

    @property
    def applied(self) -> list[float]:
        """The sum that was published last, (k,), N m."""
        return self._moments[0].tolist()

    def publish(self, stamp_ns: int, applied: np.ndarray, human: np.ndarray, agent: np.ndarray, is_due: bool) -> None:
        """Publish the sum and its parts, each (k,), N m, if one of them has changed or ``is_due``."""
        moments = np.array((applied, human, agent))
        if not is_due and (moments == self._moments).all():
            return
        self._moments = moments
        set_ns(self._wrench.header.stamp, stamp_ns)
        for publisher, moment in zip(self._publishers, moments, strict=True):
            set_moment(self._wrench, moment, self._axes)
            publisher.publish(self._wrench)
