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

"""The baselines by name (entry points of the group ``shared_control.learners``), and all that can be set of them.

How each was tuned: docs/explanation/baselines.md.
"""

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, ClassVar

from pydantic import ConfigDict, Field
from shared_control.tasks.balance import BALANCE

from ..presets import Preset
from ..settings import Fraction, Layers, NotNegative, Positive
from .needs import check_errors, scales_of

if TYPE_CHECKING:
    from ..learner import Learner

_STRICT = ConfigDict(extra='forbid', allow_inf_nan=False)


@dataclass(frozen=True)
class BaselinePreset(Preset):
    """A baseline."""

    learner: str = ''
    """``module:Class``, of a class in this folder that is made with name, task, settings and seed."""

    def make(self, seed: int = 0) -> 'Learner':
        """See :class:`Preset`."""
        module, _, name = self.learner.partition(':')
        return getattr(import_module(f'.{module}', __package__), name)(self.name, self.task, self.settings, seed)


@dataclass(frozen=True)
class PdSettings:
    """Settings of :class:`.pd.PdController`."""

    __pydantic_config__: ClassVar = _STRICT

    stiffness: NotNegative = 80.0
    """N m for each metre of the position error."""
    damping: NotNegative = 50.0
    """N m against each m/s."""
    level: Annotated[float, Field(ge=-20, le=20)] = -2.0
    """The moment that levels the tray, N m."""


@dataclass(frozen=True)
class LqrSettings:
    """What a regulator weighs (:mod:`.lqr`), by Bryson's rule: each as much as the others at these values."""

    __pydantic_config__: ClassVar = _STRICT

    error: Positive = 0.1
    """Position error, m."""
    velocity: Positive = 0.15
    """Velocity, m/s."""
    moment: Positive = 8.0
    """N m."""


@dataclass(frozen=True)
class IdentifiedLqrSettings:
    """Settings of :class:`.identified_lqr.IdentifiedLqr`."""

    __pydantic_config__: ClassVar = _STRICT

    error: Positive = 1.0
    """A position error, as it is observed (scaled), that weighs as much as a ``moment``."""
    moment: Positive = 1.0
    """In actions."""
    memory_episodes: Annotated[int, Field(ge=1, le=100)] = 20
    """Transitions of so many episodes make the model."""
    excitation: Positive = 1.0
    """Standard deviation of the exciting moment in the first episode, in actions."""
    excitation_decay: Fraction = 0.5
    """What it is multiplied by after each episode."""
    excitation_seconds: Positive = 0.4
    """Correlation time of the exciting moment, s."""


@dataclass(frozen=True)
class CloningSettings:
    """Settings of :class:`.cloning.BehaviourCloning` and :class:`.cloning.HgDagger`."""

    __pydantic_config__: ClassVar = _STRICT

    ridge: Positive = 0.01
    """Towards no moment, in steps."""


@dataclass(frozen=True)
class DCoachSettings:
    """Settings of :class:`.dcoach.DCoach`, with the paper's names for them."""

    __pydantic_config__: ClassVar = _STRICT

    hidden: Layers = (16, 16)
    """Units of the policy's hidden layers."""
    error: Positive = 1.0
    """e: how far a correction moves the label, in actions."""
    learning_rate: Positive = 0.003
    """That of gradient descent."""
    memory: Annotated[int, Field(ge=1, le=100_000)] = 3000
    """K: so many corrections are remembered."""
    batch_size: Annotated[int, Field(ge=1, le=100_000)] = 64
    """N: corrections of a minibatch."""
    replay_every: Annotated[int, Field(ge=1, le=100_000)] = 1
    """b: steps from one minibatch to the next."""


@dataclass(frozen=True)
class OffPolicySettings:
    """Settings of what replays all steps (:mod:`.off_policy`)."""

    __pydantic_config__: ClassVar = _STRICT

    hidden: Layers = (32, 32)
    """Units of the hidden layers of policy and critics."""
    learning_rate: Positive = 3e-4
    """That of Adam."""
    batch_size: Annotated[int, Field(ge=2, le=10_000)] = 128
    """Half of it interventions."""
    updates_a_step: Annotated[float, Field(gt=0, le=20)] = 2.0
    """Gradient steps for each step of the robot, after the episode."""
    gamma: Fraction = 0.98
    tau: Fraction = 0.02
    """How far the target networks follow in each gradient step."""
    noise_seconds: NotNegative = 0.0
    """Correlation time of the exploring noise, s; 0: white."""


@dataclass(frozen=True)
class SacSettings(OffPolicySettings):
    """Settings of :class:`.sac.SacInterventions`."""

    initial_entropy_weight: Positive = 0.01
    """What entropy weighs beside the reward at first; it is learned."""


@dataclass(frozen=True)
class PvpSettings(OffPolicySettings):
    """Settings of :class:`.pvp.Pvp`."""

    hidden: Layers = (128, 128)
    gamma: Fraction = 0.99
    exploring_std: NotNegative = 0.05
    """Standard deviation of the noise, in actions."""


PD = BaselinePreset('pd', BALANCE, PdSettings(), taught=False, learner='pd:PdController', needs=scales_of)
"""Gains by hand."""
LQR = BaselinePreset('lqr', BALANCE, LqrSettings(), taught=False, learner='lqr:KnownLqr', needs=scales_of)
"""An LQR on the known model of arm, controller and ball."""
IDENTIFIED_LQR = BaselinePreset(
    'identified_lqr', BALANCE, IdentifiedLqrSettings(), learner='identified_lqr:IdentifiedLqr', needs=check_errors)
"""An LQR on the model that least squares find in the episodes so far, whoever gave the moments."""
BEHAVIOUR_CLONING = BaselinePreset(
    'behaviour_cloning', BALANCE, CloningSettings(), learner='cloning:BehaviourCloning')
"""The person shows, the robot imitates."""
HG_DAGGER = BaselinePreset('hg_dagger', BALANCE, CloningSettings(), learner='cloning:HgDagger')
"""The person takes over, and the robot imitates that."""
DCOACH = BaselinePreset('dcoach', BALANCE, DCoachSettings(), learner='dcoach:DCoach')
"""Corrective advice, as published."""
SAC_INTERVENTIONS = BaselinePreset('sac_interventions', BALANCE, SacSettings(), learner='sac:SacInterventions')
"""Off-policy, from rewards and from interventions."""
PVP = BaselinePreset('pvp', BALANCE, PvpSettings(), learner='pvp:Pvp')
"""Off-policy, from interventions alone."""
