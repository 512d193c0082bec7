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

"""What a learning or testing loop reports while it runs."""

from shared_control.plant import PlantInterrupted

from .episode import Episode


class Callbacks:
    """What learning and testing report, and the one thing that they ask. Override what is of interest."""

    def should_stop(self) -> bool:
        """Called before each episode of learning: whether to leave it at that."""
        return False

    def episode_started(self, episode: Episode) -> None:
        """The ball is about to be dropped; ``episode`` fills up from now on."""

    def stepped(self, episode: Episode) -> None:
        """One policy period has passed."""

    def learning_started(self, episode: Episode) -> None:
        """The episode is over, the update begins: the time to let the arm rest."""

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """The update is done, the learner consistent: the time to save it, and the last to give the episode a verdict.

        Args:
            figures: of the update, by name.
        """

    def episode_unlearned(self, episode: Episode) -> None:
        """The learner is again as it was before the discarded episode, and consistent: the time to save it."""

    def episode_tested(self, episode: Episode) -> None:
        """An episode of a test is over."""

    def interrupted(self, error: PlantInterrupted) -> None:
        """The plant went away: the episode is void and begins anew."""
