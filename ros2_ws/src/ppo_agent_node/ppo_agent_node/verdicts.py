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

"""What people say of episodes, on ``/human/verdict``."""

from collections.abc import Callable

from rclpy.node import Node
from shared_control.verdict import Verdict
from shared_control_learning.episode import Episode
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled

from .training_topics import TrainingTopics


class Verdicts:
    """Gives verdicts to the last episode that has ended, and publishes what stands.

    Args:
        node: the node that subscribes.
        training: publishes.
        changed: called with an episode whose verdict has changed.
    """

    def __init__(self, node: Node, training: TrainingTopics, changed: Callable[[Episode], None]):
        self._log = node.get_logger()
        self._input = Polled(node, contract.HUMAN_VERDICT, depth=contract.HUMAN_VERDICT.qos.depth)
        self._training = training
        self._changed = changed
        self._episode: Episode | None = None
        """The last that has ended; None when there is none, or when it is settled."""

    def episode_ended(self, episode: Episode) -> None:
        """Verdicts are about this one from now on; those that wait were about the one before."""
        self.poll()
        self._episode = episode
        self._training.verdict(episode.phase, episode.number, episode.verdict)

    def close(self) -> None:
        """What was said of the last episode is settled."""
        self.poll()
        self._episode = None

    def poll(self) -> None:
        """Take what was said."""
        while (message := self._input.take()) is not None:
            self._judge(message.data)

    def _judge(self, word: str) -> None:
        try:
            said = Verdict(word)
        except ValueError:
            self._log.error(
                f'dropped a message on {self._input.topic_name}: {word!r} is none of '
                f'{", ".join(verdict for verdict in Verdict if verdict)}', throttle_duration_sec=1.0)
            return
        episode = self._episode
        if episode is None:
            self._log.warning('there is no episode to judge', throttle_duration_sec=1.0)
            return
        if said is Verdict.DISCARD and episode.phase == 'test':
            self._log.warning('episodes of a test all count: none can be discarded', throttle_duration_sec=1.0)
            return
        episode.verdict = episode.verdict.after(said)
        self._training.verdict(episode.phase, episode.number, episode.verdict)
        self._changed(episode)
