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

"""What a task is to everything else: simulator, controller, agent, screens, recorder and reports read it from here."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from ..bounds import bounded
from ..keys import KeyMap
from ..plant import PlantState
from ..rates import POLICY_PERIOD
from ..robot.model import RobotModel
from ..scene import Scene


class TaskState(Protocol):
    """What a task makes of the plant, SI units; a task's own state has more.

    Numbers, or tuples of them: Gymnasium compares states, as parts of ``info``.
    """

    position_error: float
    """Goal minus ball, m: signed along the axis of a task with one, a distance (0 or more) with two."""
    velocity: float
    """Velocity of the ball, m/s: signed or a speed, likewise."""
    manipulability: float
    """k_w (34)"""


@dataclass(frozen=True)
class Task(ABC):
    """A task that a person and a robot do together by moments on the tray.

    A task is a frozen dataclass: its fields are its settings, kept with every policy and session; a task of that class
    is made without any. ``k`` is the number of its axes; moments are vectors of that length everywhere, in the order
    of ``axes``.
    """

    __pydantic_config__: ClassVar[dict[str, Any]] = {'extra': 'forbid', 'allow_inf_nan': False}
    # For whoever reads settings from a file (shared_control_learning.policy_file).

    name: ClassVar[str]
    """Under which it is found (entry point of the group ``shared_control.tasks``)."""
    axes: ClassVar[tuple[int, ...]]
    """Rows of the wrench at the tray (fx, fy, fz, mx, my, mz) that are shared, (k,)."""
    keys: ClassVar[KeyMap]
    """Which key moves which axis, and which way."""
    scene: ClassVar[Scene]
    """All geometry."""
    reward_names: ClassVar[tuple[str, ...]]
    """The terms that :meth:`reward_terms` may have."""
    observation_size: ClassVar[int]
    errors: ClassVar[tuple[int, ...]] = ()
    """Which entries of the observation are position errors, so that their integral can be observed, too."""
    instruction: ClassVar[str] = 'Bring the ball to the centre of the tray and keep it there.'
    """What is asked of person and robot, a sentence."""
    preset: ClassVar[str] = 'coached'
    """How it is learned where nobody names a preset (entry point of the group ``shared_control.learners``)."""
    test_seconds: ClassVar[float] = 10.0
    """Length of an episode of the randomised test, s (4.2)."""

    episode_seconds: float = 15.0
    """Length of an episode of teaching, s (3.1)."""
    reward_scale: float = 1.0
    """What the reward is multiplied by before a learner sees it."""
    integrates: bool = False
    """Whether the integral of the position errors is observed, too: a policy with it does away with what pushes the
    ball to one side for good, such as a tray that sits askew."""

    @property
    def observed_size(self) -> int:
        """How many numbers a learner sees: ``observation_size``, and an integral for each of ``errors``."""
        return self.observation_size + (len(self.errors) if self.integrates else 0)

    @property
    @abstractmethod
    def scale(self) -> np.ndarray:
        """The agent's moment at a full action of 1, (k,), N m."""

    @property
    @abstractmethod
    def limit(self) -> np.ndarray:
        """Bound of the sum of both moments, (k,), N m."""

    @abstractmethod
    def ball_start(self, random: np.random.Generator) -> np.ndarray:
        """Where the ball is dropped at the start of an episode, base frame, (3,), m."""

    def aim(self, ball: np.ndarray) -> np.ndarray:
        """Where a simulated tutor would send a ball that is at ``ball``: the goal, or a way-point on the way there.

        Both (2,), m, in the frame of the tray: the scene's goal unless a task overrides this.
        """
        return np.array(self.scene.goal)

    @abstractmethod
    def describe(self, state: PlantState, model: RobotModel) -> Any:
        """What the task looks at, a :class:`TaskState`."""

    def on_tray(self, state: Any) -> tuple[float, float] | None:
        """Where the ball is, in the tray's frame, m, for tracks seen from above; None unless a task overrides this."""
        return None

    @abstractmethod
    def observe(self, state: Any) -> np.ndarray:
        """What the learner sees, (observation_size,), float32, within ``OBSERVATION_BOUND``."""

    @abstractmethod
    def reward_terms(self, state: Any) -> dict[str, float]:
        """The terms of the reward by name, unscaled."""

    @abstractmethod
    def failed(self, state: Any) -> bool:
        """Whether the episode has failed, and ends."""

    @abstractmethod
    def succeeded(self, position_error: np.ndarray, velocity: np.ndarray, failed: bool) -> bool:
        """Whether an episode alone was a success. Tracks of :class:`TaskState` at the policy's rate, (steps,) each."""


OBSERVATION_BOUND = 20.0
"""Observations are clipped to this."""
SETTLED_SECONDS = 3.0
"""The end of an episode, over which a settled ball is judged, s."""


def settled(track: np.ndarray) -> float:
    """Mean magnitude over the last 3 s of a track at the policy's rate."""
    return float(np.abs(track[-round(SETTLED_SECONDS / POLICY_PERIOD):]).mean())


INTEGRAL_BOUND = 2.0
"""Integrals of position errors, as they are observed (scaled) times s, are kept within this: so none winds up."""


class Observer:
    """What a learner sees of an episode: the task's observation and, when the task ``integrates``, the integrals.

    Args:
        task: whose observation it is.

    Raises:
        ValueError: it is to integrate, and its observation has no position errors.
    """

    def __init__(self, task: Task):
        if task.integrates and not task.errors:
            raise ValueError(f'the task {task.name} has no position errors to integrate: set integrates to false')
        self._task = task
        self.reset()

    def reset(self) -> None:
        """Begin an episode."""
        self._integral = np.zeros(len(self._task.errors))

    def observe(self, state: Any, elapsed: float) -> np.ndarray:
        """(observed_size,), float32, ``elapsed`` s after the last one."""
        seen = self._task.observe(state)
        if not self._task.integrates:
            return seen
        self._integral = integrated(self._integral, seen[list(self._task.errors)], elapsed)
        return np.append(seen, self._integral).astype(np.float32)


def integrated(integral: np.ndarray, errors: np.ndarray, seconds: float) -> np.ndarray:
    """``integral`` after ``errors`` (both as observed) have lasted ``seconds`` s."""
    return bounded(integral + seconds * errors, INTEGRAL_BOUND)


class BallStarts:
    """Where the ball is dropped, episode after episode, as a task draws it.

    Args:
        task: the task.
        seed: the same seed gives the same starts, here, in the simulator node and in the environment.
    """

    def __init__(self, task: Task, seed: int | None = None):
        self._task = task
        self.seed(seed)

    def seed(self, seed: int | None) -> None:
        """Begin the sequence that belongs to ``seed``."""
        self._random = np.random.default_rng(seed)

    def next(self) -> np.ndarray:
        """In the base frame, (3,), m."""
        return self._task.ball_start(self._random)
