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

"""The plan of a study, from a YAML file."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import yaml
from shared_control.seeds import episode_seed
from shared_control.teaching.families import draw_individual, spread_around
from shared_control.teaching.profiles import PROFILES, profile
from shared_control.teaching.tutors import Who
from shared_control_learning.wrong_content import what_is_wrong

from .plan_file import SIZE_MAX, TESTS, Learning, People, Simulated, parse, quick

PERSON = 'person'
"""The group of real participants."""


class PlanError(ValueError):
    """A plan cannot be used; the message names file and key, and says what is expected."""


class Condition(Learning):
    """One way to learn."""

    name: str


@dataclass(frozen=True)
class Participant:
    """One participant; a number, never a name."""

    number: int
    """From 1."""
    group: str
    """The profile or family that a simulated one was drawn of, or ``person``."""
    seed: int
    """Seed of everything random, the same in every condition: so conditions are paired."""
    tutor: Who | None
    """The simulated tutor; None for a real one."""

    @property
    def label(self) -> str:
        """As in the names of folders."""
        return f'p{self.number:02d}'


@dataclass(frozen=True)
class Job:
    """One run: a participant in a condition."""

    participant: Participant
    condition: Condition

    @property
    def name(self) -> str:
        """Unique within the study; its folder below ``runs``."""
        return f'{self.condition.name}/{self.participant.label}'


@dataclass(frozen=True)
class Plan:
    """A study."""

    seed: int
    participants: tuple[Participant, ...]
    conditions: tuple[Condition, ...]
    tests: tuple[str, ...] = TESTS
    """What every policy goes through at the end."""
    checkpoints: tuple[int, ...] = ()
    """After how many episodes policies go through the randomised test, too."""
    people: People | None = None
    """None: participants are simulated."""
    jobs: tuple[Job, ...] = field(init=False)
    """Every run; those that may take longest come first."""

    def __post_init__(self) -> None:
        jobs = [Job(participant, condition) for condition in sorted(self.conditions, key=lambda c: -c.episodes)
                for participant in self.participants]
        object.__setattr__(self, 'jobs', tuple(jobs))

    def participant(self, number: int) -> Participant:
        """The participant with a number.

        Raises:
            PlanError: there is none.
        """
        if not 1 <= number <= len(self.participants):
            raise PlanError(f'no participant {number}: this study has the numbers 1 to {len(self.participants)}')
        return self.participants[number - 1]

    def order(self, participant: Participant) -> tuple[Condition, ...]:
        """The taught conditions in a participant's order; orders rotate, so each comes first equally often."""
        taught = tuple(condition for condition in self.conditions if condition.taught)
        first = (participant.number - 1) % max(len(taught), 1)
        return taught[first:] + taught[:first]


def load_plan(path: Path) -> Plan:
    """Read and check a plan.

    Raises:
        PlanError: it is not what it should be; the message names file and key.
        OSError: it cannot be read.
    """
    return plan_of(read_plan(path), path)


def read_plan(path: Path, in_quick_form: bool = False) -> bytes:
    """The text of a plan, or of its quick form (:func:`.plan_file.quick`).

    Raises:
        PlanError: it has no quick form; the message names file and key.
        OSError: it cannot be read.
    """
    with path.open('rb') as file:
        text = file.read(SIZE_MAX + 1)
    try:
        return quick(text) if in_quick_form else text
    except (ValueError, yaml.YAMLError, RecursionError) as error:
        raise PlanError(f'{path}: {what_is_wrong(error)}') from error


def plan_of(text: bytes, path: Path) -> Plan:
    """The plan that a text is, which came from ``path``.

    Raises:
        PlanError: it is not what it should be; the message names file and key.
    """
    try:
        content = parse(text)
    except (ValueError, yaml.YAMLError, RecursionError) as error:
        raise PlanError(f'{path}: {what_is_wrong(error)}') from error
    who = content.participants
    conditions = tuple(Condition(name=name, **dict(settings)) for name, settings in content.conditions.items())
    return Plan(content.seed, _participants(who, content.seed), conditions, tuple(content.tests),
                tuple(sorted(set(content.checkpoints))), who if isinstance(who, People) else None)


def draw_tutor(group: str, spread: float, seed: int) -> Who:
    """A simulated tutor: ``spread`` around the profile ``group``, or an individual of the family of that name."""
    if group not in PROFILES:
        return draw_individual(group, seed)
    return spread_around(profile(group), spread, np.random.default_rng((seed, 2)))


def _participants(who: Simulated | People, seed: int) -> tuple[Participant, ...]:
    if isinstance(who, People):
        return tuple(Participant(number, PERSON, episode_seed(seed, number), None)
                     for number in range(1, who.real + 1))
    groups = [group for group, count in who.simulated.items() for _ in range(count)]
    seeds = [episode_seed(seed, number) for number in range(1, len(groups) + 1)]
    return tuple(Participant(number, group, own, draw_tutor(group, who.spread, own))
                 for number, (group, own) in enumerate(zip(groups, seeds, strict=True), start=1))
