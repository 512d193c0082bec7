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

"""The file that keeps the final test of a policy alone (``test.json``)."""

import hashlib
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from pydantic import TypeAdapter, ValidationError
from shared_control.files import write_atomically
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import settled
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import Evaluation
from shared_control_learning.wrong_content import what_is_wrong

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
    path: tuple[tuple[float, float], ...] = ()
    """Where the ball was on the tray, m, likewise; empty for a task with one axis."""


@dataclass(frozen=True)
class FinalTest:
    """The test as kept."""

    episodes: tuple[TestedEpisode, ...]
    position_error_max: float = BALANCE.scene.goal_radius
    """Mean |position error| of a success, m."""
    velocity_max: float = BALANCE.velocity_max
    """Mean |velocity| of a success, m/s."""
    sample_period: float = STEPS_PER_SAMPLE * POLICY_PERIOD
    """Sample period of the tracks, s."""
    policy: str = ''
    """SHA-256 of the policy file that was tested; empty when not known."""

    @property
    def successes(self) -> int:
        """Successful episodes."""
        return sum(episode.success for episode in self.episodes)


_FINAL_TEST = TypeAdapter(FinalTest)


def save_test(evaluation: Evaluation, path: Path, policy: str = '') -> FinalTest:
    """Keep an evaluation of the policy file with this SHA-256 in ``path``."""
    task = evaluation.episodes[0].task
    test = FinalTest(
        tuple(_tested(episode) for episode in evaluation.episodes), task.scene.goal_radius,
        getattr(task, 'velocity_max', FinalTest.velocity_max), policy=policy)
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
        return _FINAL_TEST.validate_json(path.read_bytes())
    except ValidationError as error:
        raise ValueError(f'{path} is no result of a test: {what_is_wrong(error)}') from error


def sha256(path: Path) -> str:
    """SHA-256 of a file, as hexadecimal digits."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _tested(episode: Episode) -> TestedEpisode:
    track = tuple(round(float(error), 5) for error in episode.position_error[::STEPS_PER_SAMPLE])
    return TestedEpisode(
        success=episode.success, kept=not episode.failed, position_error=settled(np.array(episode.position_error)),
        velocity=settled(np.array(episode.velocity)), ball_start=float(episode.position_error[0]), track=track,
        path=tuple((round(x, 5), round(y, 5)) for x, y in episode.on_tray[::STEPS_PER_SAMPLE]))
