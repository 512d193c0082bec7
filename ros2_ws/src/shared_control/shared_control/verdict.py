"""What a person says of an episode that has ended."""

from enum import StrEnum


class Verdict(StrEnum):
    """A word on ``/human/verdict`` and ``/training/verdict``: a label, which changes neither reward nor task."""

    NONE = ''
    """Nothing was said, or it was taken back."""
    SUCCESS = 'success'
    FAILURE = 'failure'
    DISCARD = 'discard'
    """It does not count: nobody is to learn from it."""

    def after(self, said: 'Verdict') -> 'Verdict':
        """What stands when ``said`` comes on top of this: the same again takes it back."""
        return Verdict.NONE if said is self else said


def episode_key(phase: str, number: int) -> str:
    """What ``/training/verdict`` calls an episode, such as ``teach 4``."""
    return f'{phase} {number}'


def split_episode_key(key: str) -> tuple[str, int]:
    """Phase and number of the episode that :func:`episode_key` names.

    Raises:
        ValueError: it is no such name.
    """
    phase, _, number = key.partition(' ')
    return phase, int(number)
