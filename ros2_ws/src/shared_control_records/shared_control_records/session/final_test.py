"""The file that keeps the final test of a policy alone (``test.json``)."""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from shared_control.files import write_atomically
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.balance.task import settled
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import Evaluation

STEPS_PER_SAMPLE = 5
"""A track is kept at 10 Hz."""


@dataclass(frozen=True)
class TestedEpisode:
    """One episode of the test."""

    success: bool
    """Kept, and at rest in the centre at the end."""
    kept: bool
    """The ball never fell."""
    position_error: float
    """Mean |position error| of the last 3 s, m"""
    velocity: float
    """Mean |velocity| of the last 3 s, m/s"""
    ball_start: float
    """Position error at the start, m"""
    track: tuple[float, ...] = ()
    """Position error, m, every ``sample_period``"""


@dataclass(frozen=True)
class FinalTest:
    """The test as kept."""

    episodes: tuple[TestedEpisode, ...]
    position_error_max: float = BALANCE.scene.goal_radius
    """Mean |position error| of a success, m."""
    velocity_max: float = BALANCE.velocity_max
    """Mean |velocity| of a success, m/s."""
    sample_period: float = STEPS_PER_SAMPLE * POLICY_PERIOD
    """Of the tracks, s."""

    @property
    def successes(self) -> int:
        """Successful episodes."""
        return sum(episode.success for episode in self.episodes)


def save_test(evaluation: Evaluation, path: Path) -> FinalTest:
    """Keep an evaluation in ``path``."""
    test = FinalTest(tuple(_tested(episode) for episode in evaluation.episodes))
    content = {'successes': test.successes, **asdict(test)}
    write_atomically(path, json.dumps(content, indent=1).encode())
    return test


def load_test(path: Path) -> FinalTest | None:
    """What :func:`save_test` wrote; None when there is no such file.

    Raises:
        ValueError: the file is something else; the message names it.
    """
    if not path.is_file():
        return None
    try:
        content = json.loads(path.read_text())
        episodes = tuple(
            TestedEpisode(**{**_known(TestedEpisode, episode), 'track': tuple(episode.get('track', ()))})
            for episode in content['episodes'])
        return FinalTest(**{**_known(FinalTest, content), 'episodes': episodes})
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f'{path} is no result of a test: {error!r}') from error


def _tested(episode: Episode) -> TestedEpisode:
    track = tuple(round(float(error), 5) for error in episode.position_error[::STEPS_PER_SAMPLE])
    return TestedEpisode(
        success=episode.success, kept=not episode.failed, position_error=settled(np.array(episode.position_error)),
        velocity=settled(np.array(episode.velocity)), ball_start=float(episode.position_error[0]), track=track)


def _known(kind: type, content: dict[str, Any]) -> dict[str, Any]:
    """What ``kind`` has a field for."""
    return {field.name: content[field.name] for field in fields(kind) if field.name in content}
