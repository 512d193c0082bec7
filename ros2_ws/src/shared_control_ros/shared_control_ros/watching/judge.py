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

"""A person's verdict on the last episode that has ended."""

from collections.abc import Callable

from rclpy.node import Node
from shared_control.verdict import Verdict
from std_msgs.msg import String

from .. import contract
from .observer import EPISODES
from .scene import Scene
from .words import ALL_TESTS_COUNT, NOTHING_TO_JUDGE, words_of_verdict


class Judge:
    """Publishes verdicts, and tells the person what has become of them.

    Args:
        tell: takes a line for the person.
    """

    def __init__(self, node: Node, tell: Callable[[str], None]):
        self._tell = tell
        self._publisher = node.create_publisher(
            contract.HUMAN_VERDICT.msg_type, contract.HUMAN_VERDICT.name, contract.HUMAN_VERDICT.qos)
        self._told: tuple[tuple[str, int] | None, Verdict] = None, Verdict.NONE

    def say(self, scene: Scene, verdict: Verdict) -> None:
        """Give a verdict; the same again takes it back."""
        if scene.ended is None:
            self._tell(NOTHING_TO_JUDGE)
        elif verdict is Verdict.DISCARD and scene.ended[0] == 'test':
            self._tell(ALL_TESTS_COUNT)
        else:
            self._publisher.publish(String(data=str(verdict)))

    def update(self, scene: Scene) -> None:
        """Tell what the learner has made of a verdict, whoever gave it."""
        before, self._told = self._told, (scene.ended, scene.verdict)
        if scene.ended is not None and scene.ended == before[0] and scene.verdict is not before[1]:
            self._tell(words_of_verdict(*scene.ended, scene.verdict, is_running=scene.phase in EPISODES))
