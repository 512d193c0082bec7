"""What a learning or testing loop tells those who look on."""

from shared_control.plant import PlantInterrupted

from .record import EpisodeRecord


class Hooks:
    """What learning and testing tell as they go on, and the one thing that they ask. Override what is of interest."""

    def stop(self) -> bool:
        """Asked before each episode of learning: whether to leave it at that."""
        return False

    def episode_started(self, record: EpisodeRecord) -> None:
        """The ball is about to be dropped; ``record`` fills up from now on."""

    def stepped(self, record: EpisodeRecord) -> None:
        """One policy period has passed."""

    def learning_started(self, record: EpisodeRecord) -> None:
        """The episode is over, the update begins: the time to let the arm rest."""

    def episode_learned(self, record: EpisodeRecord) -> None:
        """The update is done, the learner consistent: the time to save it."""

    def episode_tested(self, record: EpisodeRecord) -> None:
        """An episode of a test is over."""

    def interrupted(self, error: PlantInterrupted) -> None:
        """The plant went away: the episode is void and begins anew."""
