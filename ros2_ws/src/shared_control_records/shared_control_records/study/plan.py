"""The plan of a study, from a YAML file."""

from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from shared_control.seeds import episode_seed
from shared_control.teaching.profiles import PROFILES, TutorProfile, profile
from shared_control_learning.presets import preset

TESTS = ('randomized', 'perturbation', 'trajectory')
PERSON = 'person'
"""The group of real participants."""


class PlanError(ValueError):
    """A plan cannot be used; the message names file and key, and says what is expected."""


@dataclass(frozen=True)
class Condition:
    """One way to learn."""

    name: str
    preset: str
    """Of ``learning.presets``; the condition's name when the plan does not say."""
    episodes: int = 20
    """Training ends here for who is not skilled by then."""
    taught: bool = True
    """Whether the participant teaches; otherwise the robot learns alone, from the same seed."""
    evaluate_every: int = 1
    """Episodes between two tests of whether the robot is skilled."""


@dataclass(frozen=True)
class Participant:
    """One participant; a number, never a name."""

    number: int
    """From 1."""
    group: str
    """The profile that a simulated one was drawn around, or ``person``."""
    seed: int
    """Of everything random, the same in every condition: so conditions are paired."""
    tutor: TutorProfile | None
    """The simulated tutor; None for a real one."""

    @property
    def label(self) -> str:
        """As in the names of folders."""
        return f'p{self.number:02d}'


@dataclass(frozen=True)
class People:
    """What real participants do."""

    consent: str
    """The text that they agree to before anything is recorded."""
    practice_episodes: int = 2
    """To get to know the keys; kept apart."""
    minutes: float = 45.0
    """Of teaching in each condition, at the most (3.4)."""
    session_options: tuple[str, ...] = ()
    """More options of ``shared-control session``, such as ``--params-file``."""


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
    try:
        content = yaml.safe_load(path.read_text())
        needed = {'participants', 'conditions'}
        top = _section(content, 'the plan', {'seed', 'tests', *needed}, needed)
        seed = _number(top, 'seed', int, 0, default=0)
        conditions = tuple(_condition(name, settings) for name, settings in _named(top, 'conditions').items())
        tests = tuple(_list(top.get('tests', list(TESTS)), 'tests', TESTS))
        participants, people = _participants(top['participants'], seed)
        return Plan(seed, participants, conditions, tests, people)
    except (PlanError, yaml.YAMLError, UnicodeDecodeError) as error:
        raise PlanError(f'{path}: {error}') from error


def draw_tutor(group: str, spread: float, seed: int) -> TutorProfile:
    """A simulated tutor around the profile ``group``: each number times ``exp(spread z)``, z standard normal."""
    base = profile(group)
    random = np.random.default_rng((seed, 2))
    numbers = [f.name for f in fields(base) if type(getattr(base, f.name)) is float]
    factors = np.exp(spread * random.standard_normal(len(numbers)))
    return replace(base, **{name: getattr(base, name) * float(factor)
                            for name, factor in zip(numbers, factors, strict=True)})


def _participants(content: Any, seed: int) -> tuple[tuple[Participant, ...], People | None]:
    if isinstance(content, dict) and 'real' in content:
        known = {'real', 'consent', 'practice_episodes', 'minutes', 'session_options'}
        section = _section(content, 'participants', known, {'real', 'consent'})
        count = _number(section, 'real', int, 1)
        options = section.get('session_options', [])
        if not isinstance(section['consent'], str) or not section['consent'].strip():
            raise PlanError('participants.consent must be the text that participants agree to')
        people = People(
            section['consent'].strip(), _number(section, 'practice_episodes', int, 0, default=2),
            _number(section, 'minutes', float, 0.1, default=45.0), tuple(_list(options, 'session_options', None)))
        return tuple(Participant(number, PERSON, episode_seed(seed, number), None)
                     for number in range(1, count + 1)), people
    section = _section(content, 'participants', {'simulated', 'spread'}, {'simulated'})
    spread = _number(section, 'spread', float, 0.0, default=0.15)
    groups: list[str] = []
    for group in _named(section, 'simulated'):
        if group not in PROFILES:
            raise PlanError(f'participants.simulated: no profile {group!r}; there are {", ".join(PROFILES)}')
        groups += [group] * _number(section['simulated'], group, int, 1)
    return tuple(
        Participant(number, group, episode_seed(seed, number), draw_tutor(group, spread, episode_seed(seed, number)))
        for number, group in enumerate(groups, start=1)), None


def _condition(name: str, settings: Any) -> Condition:
    where = f'conditions.{name}'
    if not name.replace('_', '').replace('-', '').isalnum():
        raise PlanError(f'{where}: a condition is named by letters, digits, _ and -')
    section = _section(settings or {}, where, {'preset', 'episodes', 'taught', 'evaluate_every'}, set())
    chosen = section.get('preset', name)
    try:
        preset(chosen)
    except (ValueError, TypeError) as error:
        raise PlanError(f'{where}.preset: {error}') from error
    taught = section.get('taught', True)
    if not isinstance(taught, bool):
        raise PlanError(f'{where}.taught is {taught!r}, expected true or false')
    return Condition(name, chosen, _number(section, 'episodes', int, 1, default=20), taught,
                     _number(section, 'evaluate_every', int, 1, default=1))


def _section(content: Any, where: str, known: set[str], needed: set[str]) -> dict[str, Any]:
    if not isinstance(content, dict):
        raise PlanError(f'{where} is {content!r}, expected keys ({", ".join(sorted(known))}) with values')
    if unknown := [str(key) for key in content if key not in known]:
        raise PlanError(f'{where} has no key {", ".join(unknown)}; there are {", ".join(sorted(known))}')
    if missing := sorted(needed - content.keys()):
        raise PlanError(f'{where} lacks {", ".join(missing)}')
    return content


def _named(section: dict[str, Any], key: str) -> dict[str, Any]:
    """A section with at least one entry, whose keys are names of the user's."""
    content = section[key]
    if not isinstance(content, dict) or not content or not all(isinstance(name, str) for name in content):
        raise PlanError(f'{key} is {content!r}, expected at least one NAME: SETTINGS')
    return content


def _number(section: dict[str, Any], key: str, kind: type, minimum: float, default: Any = None) -> Any:
    value = section.get(key, default)
    allowed = (int, float) if kind is float else (int,)
    if isinstance(value, bool) or not isinstance(value, allowed) or not minimum <= value < 2**31:
        raise PlanError(f'{key} is {value!r}, expected {"a whole number" if kind is int else "a number"} '
                        f'of at least {minimum:g}')
    return kind(value)


def _list(content: Any, key: str, allowed: tuple[str, ...] | None) -> list[str]:
    if not isinstance(content, list) or not all(isinstance(entry, str) for entry in content):
        raise PlanError(f'{key} is {content!r}, expected a list of texts')
    if allowed is not None and (wrong := [entry for entry in content if entry not in allowed]):
        raise PlanError(f'{key}: no {", ".join(wrong)}; there are {", ".join(allowed)}')
    return content
