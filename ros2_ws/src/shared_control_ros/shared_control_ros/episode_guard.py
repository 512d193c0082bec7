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

"""Keeps others from putting arm and ball back in an episode of a learner, who would learn from it as it then is."""

from rclpy.node import Node

from . import contract


class EpisodeGuard:
    """Whether a learner has an episode under way: it has let time go on, and is still there.

    Args:
        node: of a simulator, or of a robot; one that cannot rest is told when to all the same.
    """

    def __init__(self, node: Node):
        self._node = node
        self._topic = node.resolve_topic_name(contract.AGENT_WRENCH.name)
        self._goes_on = False

    def rest(self, rests: bool) -> None:
        """The learner has called ``simulator/rest``."""
        self._goes_on = not rests

    @property
    def has_learner(self) -> bool:
        """Whether there is a learner at all."""
        return bool(self._node.count_publishers(self._topic))

    def refusal(self) -> str:
        """Why a reset is refused; empty: it is not."""
        if not self._goes_on or not self.has_learner:
            return ''
        repeat = self._node.resolve_service_name(contract.REPEAT_SERVICE)
        return f'the learner has an episode under way, and would learn from it: {repeat} starts it over'
