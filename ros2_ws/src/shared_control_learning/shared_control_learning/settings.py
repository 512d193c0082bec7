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

"""Everything that can be set of PPO and of what corrections teach it."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from pydantic import ConfigDict, Field
from shared_control.tasks.settings_check import LARGEST, SMALLEST

Positive = Annotated[float, Field(ge=SMALLEST, le=LARGEST)]
NotNegative = Annotated[float, Field(ge=0, le=LARGEST)]
Fraction = Annotated[float, Field(ge=0, le=1)]
Layers = Annotated[tuple[Annotated[int, Field(ge=1, le=1024)], ...], Field(max_length=4)]
Delay = Annotated[float, Field(ge=0, le=5)]
_STRICT = ConfigDict(extra='forbid', allow_inf_nan=False)


@dataclass(frozen=True)
class PpoSettings:
    """Settings of PPO (Schulman et al., 2017) with one update an episode."""

    __pydantic_config__: ClassVar = _STRICT

    hidden: Layers = ()
    """Units of the policy's hidden layers (tanh). None at all: a linear policy of three weights and a bias."""
    value_hidden: Layers = (32, 32)
    """Units of the value function's hidden layers (tanh)."""
    initial_std: Positive = 0.6
    """Standard deviation of the policy in the first episode, in units of the action."""
    std_decay: Annotated[float, Field(gt=0, le=1)] | None = 0.95
    """What the standard deviation is multiplied by after each episode; None: PPO learns it."""
    std_min: Positive = 0.05
    """The least standard deviation that a decay leads to."""
    noise_seconds: NotNegative = 0.0
    """Correlation time of the exploring noise, s; 0: white, drawn anew at each step."""
    learning_rate: Positive = 1e-2
    """Learning rate of Adam in the first episode."""
    learning_rate_decay: Annotated[float, Field(gt=0, le=1)] = 1.0
    """What the learning rate is multiplied by after each episode."""
    learning_rate_min: Positive = 1e-3
    """The least learning rate that a decay leads to."""
    learning_rate_end: Fraction = 1.0
    """What part of the learning rate is left after an update; it falls linearly, epoch by epoch."""
    epochs: Annotated[int, Field(ge=1, le=1000)] = 10
    batch_size: Annotated[int, Field(ge=2, le=100_000)] = 125
    gamma: Fraction = 0.99
    gae_lambda: Fraction = 0.95
    clip_range: Positive = 0.2
    entropy_weight: NotNegative = 0.0
    value_weight: NotNegative = 0.5
    max_gradient_norm: Positive = 0.5

    def std_in(self, episode: int) -> float | None:
        """The policy's standard deviation in ``episode`` (from 1); None when it is learned."""
        return None if self.std_decay is None else max(self.std_min, self.initial_std * self.std_decay ** (episode - 1))

    def learning_rate_in(self, episode: int) -> float:
        """Learning rate of the update after ``episode`` (from 1)."""
        rate = self.learning_rate * self.learning_rate_decay ** (episode - 1)
        return max(rate, min(self.learning_rate, self.learning_rate_min))


@dataclass(frozen=True)
class CoachingSettings:
    """How a correction teaches the policy."""

    __pydantic_config__: ClassVar = _STRICT

    gain: Positive = 2.0
    """g: how far a correction of a full action's moment moves the label, in units of the action."""
    delays: Annotated[tuple[Delay, ...], Field(min_length=1, max_length=100)] = (0.3, 0.4, 0.5, 0.6, 0.7)
    """D: how long after the robot's action people may press, s. Each correction counts for all of them."""
    memory_episodes: Annotated[int, Field(ge=1, le=1000)] = 3
    """Corrections of so many episodes are taught, again and again."""
    weight: NotNegative = 1.0
    """lambda in the first episode."""
    fade_episodes: Annotated[int, Field(ge=1, le=100_000)] = 8
    """The episode from which on lambda is 0; it falls linearly until then."""

    def weight_in(self, episode: int) -> float:
        """lambda in ``episode`` (from 1)."""
        return self.weight * max(0.0, 1.0 - (episode - 1) / self.fade_episodes)


@dataclass(frozen=True)
class PpoLearnerSettings:
    """How PPO learns, and whether a person's corrections teach it, too."""

    __pydantic_config__: ClassVar = _STRICT

    ppo: PpoSettings
    coaching: CoachingSettings | None = None
    """None: PPO is told nothing of the human."""


@dataclass(frozen=True)
class ModelSettings:
    """How a model of the transitions improves the policy (:mod:`shared_control_learning.guided_learner`)."""

    __pydantic_config__: ClassVar = _STRICT

    memory_episodes: Annotated[int, Field(ge=1, le=100)] = 20
    """Transitions of so many episodes make the model."""
    periods: Annotated[int, Field(ge=1, le=50)] = 5
    """Policy periods of one imagined step, in which the moment is held."""
    steps: Annotated[int, Field(ge=1, le=1000)] = 60
    """Length of an imagined episode."""
    batch: Annotated[int, Field(ge=1, le=10_000)] = 48
    """Imagined episodes."""
    iterations: Annotated[int, Field(ge=1, le=1000)] = 12
    """Iterations of the optimiser (L-BFGS) after each episode."""
    push: NotNegative = 0.6
    """Standard deviation of a moment that pushes for good, another in each imagined episode, in actions: what an
    integral is good for."""
    restlessness: NotNegative = 0.5
    """Cost of the squared change of the action from one imagined step to the next, in rewards."""


@dataclass(frozen=True)
class GuidedSettings(PpoLearnerSettings):
    """PPO, and a model of the transitions in which the policy is improved."""

    model: ModelSettings = ModelSettings()
