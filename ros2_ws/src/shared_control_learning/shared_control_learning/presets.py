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

"""What is learned and how, by name: each is an entry point of the group ``shared_control.learners``."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from shared_control.control.sharing import ADDITIVE, Sharing
from shared_control.plugins import LEARNERS, TASKS, load
from shared_control.tasks.balance import BALANCE, THESIS
from shared_control.tasks.task import Task

from .settings import CoachingSettings, GuidedSettings, PpoLearnerSettings, PpoSettings

if TYPE_CHECKING:
    from .learner import Learner


@dataclass(frozen=True)
class Preset(ABC):
    """A task, and a way to learn it. Quick to load: what is heavy is imported when a learner is made."""

    name: str
    task: Task
    settings: Any
    """A frozen dataclass of everything that can be set, kept with every policy."""
    taught: bool = True
    """Whether somebody is meant to be at the keys."""
    needs: Callable[[str, Task], object] | None = None
    """Raises ValueError, given the preset's name and a task, when it cannot learn that; quick. None: it learns any."""

    def check(self, sharing: Sharing = ADDITIVE) -> None:
        """Find out, quickly, whether the task can be learned like this, with moments that are shared like that.

        Raises:
            ValueError: it cannot; the message says why.
        """
        if self.needs is not None:
            self.needs(self.name, self.task)
        sharing.check(len(self.task.axes))

    @abstractmethod
    def make(self, seed: int = 0) -> 'Learner':
        """A learner of ``task`` that has learned nothing yet; ``seed``: of everything random."""


@dataclass(frozen=True)
class PpoPreset(Preset):
    """PPO, with a person's corrections or without."""

    settings: PpoLearnerSettings

    def make(self, seed: int = 0) -> 'Learner':
        """See :class:`Preset`."""
        from .ppo_learner import PpoLearner
        return PpoLearner(self.name, self.task, self.settings, seed)


@dataclass(frozen=True)
class GuidedPreset(Preset):
    """PPO, and a model of what all moments did, in which the policy is improved."""

    settings: GuidedSettings

    def make(self, seed: int = 0) -> 'Learner':
        """See :class:`Preset`."""
        from .guided_learner import GuidedLearner
        return GuidedLearner(self.name, self.task, self.settings, seed)


GUIDED = GuidedPreset('guided', replace(BALANCE, integrates=True), GuidedSettings(
    PpoSettings(initial_std=0.3, std_decay=0.93, learning_rate=1e-2, learning_rate_decay=0.93)))
"""Learns from every moment what it did, whoever gave it."""
COACHED = PpoPreset('coached', BALANCE, PpoLearnerSettings(
    PpoSettings(initial_std=0.4, std_decay=0.93, learning_rate=3e-2, learning_rate_decay=0.93), CoachingSettings()))
"""Corrections are labels, too."""
COACHED_NETWORK = PpoPreset('coached_network', BALANCE, PpoLearnerSettings(
    PpoSettings(hidden=(32, 32), initial_std=0.3, std_decay=0.93, learning_rate=1e-2, learning_rate_decay=0.95,
                learning_rate_end=0.0, epochs=40, max_gradient_norm=5.0),
    CoachingSettings(delays=(0.2, 0.3, 0.4, 0.5), memory_episodes=8, weight=100.0, fade_episodes=100)))
"""Corrections are labels of a network, which they teach more than the reward does: for what no linear law can do."""
THESIS_PPO = PpoPreset('thesis', THESIS, PpoLearnerSettings(PpoSettings(
    hidden=(64, 64), value_hidden=(64, 64), initial_std=1.0, std_decay=None, learning_rate=3e-4, batch_size=64)))
"""The human's moment is a part of the environment and nothing else (3.3, 3.4); the text gives no settings of PPO, so
they are those of Stable-Baselines3."""
AUTONOMOUS = PpoPreset('autonomous', BALANCE, PpoLearnerSettings(PpoSettings(
    initial_std=0.6, std_decay=0.95, noise_seconds=0.5, learning_rate=1e-2)), taught=False)
"""No human; tuned for a robot that nobody teaches."""


def preset(name: str) -> Preset:
    """The preset called ``name``.

    Raises:
        ValueError: there is none; the message lists the names.
    """
    return load(LEARNERS, name)


def preset_for(task: str = '', name: str = '') -> Preset:
    """The preset called ``name`` for the task called ``task``.

    Args:
        task: with its default settings, and the integrals of its errors if the preset's own task has them; the one
            that the preset was made for when empty.
        name: of the preset; the one that the task is learned by when empty, too.

    Raises:
        ValueError: there is no such task or preset; the message lists the names.
    """
    made = load(TASKS, task)() if task else BALANCE
    found = preset(name or made.preset)
    if not task or task == found.task.name:
        return found
    return replace(found, task=replace(made, integrates=found.task.integrates and bool(made.errors)))
