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

"""What the YAML file of a plan may say; docs/how_to/study.md."""

import re
from typing import Annotated, Any, Literal, get_args

import yaml
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints, field_validator, model_validator
from shared_control.control.sharing import Sharing
from shared_control.plugins import WORLDS, names
from shared_control.printable import shortened
from shared_control.strict_yaml import StrictLoader
from shared_control.teaching.picture import can_teach
from shared_control.teaching.tutors import tutor_named
from shared_control_learning.presets import preset, preset_for

Test = Literal['randomized', 'perturbation', 'trajectory', 'transfer']
TESTS: tuple[Test, ...] = get_args(Test)
SIZE_MAX = 2**20
"""Bytes; a plan takes less than a thousand."""
SESSION_OPTIONS = ('--params-file', '--tutor', '--page', '--no-screen')
"""What a plan may add to sessions of real participants: nothing that names another folder, seed or preset."""


def _known_preset(name: str) -> str:
    return preset(name).name


def _known_task(name: str) -> str:
    return preset_for(name).task.name if name else name


def _known_tutor(name: str) -> str:
    tutor_named(name)
    return name


def _known_physics(name: str) -> str:
    if name not in names(WORLDS):
        raise ValueError(f'no physics {name!r}; there are {", ".join(names(WORLDS))}')
    return name


def _folder_name(name: str) -> str:
    if not name.replace('_', '').replace('-', '').isalnum():
        raise ValueError('a condition is named by letters, digits, _ and -')
    return name


def _plain(text: str) -> str:
    if re.search(r'[\x00-\x08\x0b-\x1f\x7f-\x9f]', text):
        raise ValueError('a text that a terminal shows must not have control characters')
    return text


def _session_option(text: str) -> str:
    if text.startswith('-') and text.partition('=')[0] not in SESSION_OPTIONS:
        raise ValueError(f'{shortened(text)} is none of the options {", ".join(SESSION_OPTIONS)}')
    return text


Name = Annotated[str, Field(max_length=60)]
Count = Annotated[int, Field(ge=1, le=1000)]
Episodes = Annotated[int, Field(ge=1, le=100_000)]


class Section(BaseModel):
    """A part of a plan."""

    model_config = ConfigDict(strict=True, frozen=True, allow_inf_nan=False)

    @model_validator(mode='before')
    @classmethod
    def _knows_all_keys(cls, content: Any) -> Any:
        unknown = [key for key in content if key not in cls.model_fields] if isinstance(content, dict) else []
        if unknown:
            raise ValueError(f'no key {shortened(unknown[0])}; there are {", ".join(sorted(cls.model_fields))}')
        return content


class Learning(Section):
    """What a plan says of a condition."""

    preset: Annotated[Name, AfterValidator(_known_preset)]
    """An entry point of ``shared_control.learners``; the condition's name when the plan does not say."""
    task: Annotated[Name, AfterValidator(_known_task)] = ''
    """An entry point of ``shared_control.tasks``; what the preset was made for when the plan does not say."""
    episodes: Episodes = 20
    """Training ends here for who is not skilled by then."""
    taught: bool = True
    """Whether the participant teaches; otherwise the robot learns alone, from the same seed."""
    evaluate_every: Episodes = 1
    """Episodes between two tests of whether the robot is skilled."""
    physics: Annotated[Name, AfterValidator(_known_physics)] = 'bullet'
    """What it is trained in (an entry point of ``shared_control.worlds``)."""
    tested_in: Annotated[Name, AfterValidator(_known_physics)] | None = None
    """What the policy is tested in at the end; as trained when the plan does not say."""
    sharing: Literal['additive', 'override', 'blend', 'axes'] = 'additive'
    """What counts of the two moments (:mod:`shared_control.control.sharing`)."""

    @model_validator(mode='after')
    def _can_be_learned(self) -> 'Learning':
        known = preset_for(self.task, self.preset)
        known.check(Sharing(self.sharing))
        if self.taught and not known.taught:
            raise ValueError(f'the preset {known.name} has no tutor: say taught: false')
        return self


class Question(Section):
    """A question to a participant."""

    ask: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=1000), AfterValidator(_plain)]
    """What is asked."""
    choices: Annotated[list[Annotated[str, AfterValidator(_plain)]], Field(max_length=30)] = []
    """One of these is the answer; none: any text, or nothing."""


class People(Section):
    """What real participants do."""

    real: Count
    """How many there are."""
    consent: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1), AfterValidator(_plain)]
    """The text that they agree to before anything is recorded."""
    practice_rests: Annotated[int, Field(ge=0, le=100)] = 2
    """How often they bring the ball to rest alone, with the robot off, before they first teach."""
    practice_minutes: Annotated[float, Field(ge=0.1, le=60.0)] = 5.0
    """After this much practice they may teach in any case."""
    minutes: Annotated[float, Field(ge=0.1, le=1440.0)] = 45.0
    """Longest time of teaching in each condition (3.4)."""
    teach_on: Literal['page', 'terminal'] = 'page'
    """Where they teach, and are asked."""
    feedback: Literal['none', 'ball', 'full'] = 'ball'
    """What they are told while they teach, in either (:mod:`shared_control.teaching.feedback`)."""
    verdicts: bool = False
    """Whether they are offered to call an episode good, bad or discarded, which the robot then forgets; in either."""
    before: dict[Name, Question] = {}
    """Questions to everybody before the first session, by the name under which answers are kept."""
    after: dict[Name, Question] = {}
    """Questions at the end."""
    session_options: list[Annotated[str, AfterValidator(_session_option)]] = []
    """Some of ``SESSION_OPTIONS``, with their values."""


class Simulated(Section):
    """Who is simulated."""

    simulated: Annotated[dict[Annotated[Name, AfterValidator(_known_tutor)], Count], Field(min_length=1)]
    """How many around each profile, or of each family."""
    spread: Annotated[float, Field(ge=0.0, le=2.0)] = 0.15
    """How far individuals differ from their profile; families have their own distributions."""


class PlanFile(Section):
    """The whole file."""

    seed: Annotated[int, Field(ge=0, lt=2**31)] = 0
    participants: Simulated | People
    conditions: Annotated[
        dict[Annotated[Name, AfterValidator(_folder_name)], Learning], Field(min_length=1, max_length=100)]
    tests: Annotated[list[Test], Field(max_length=len(TESTS))] = list(TESTS)
    checkpoints: Annotated[list[Episodes], Field(max_length=20)] = []
    """After so many episodes a policy goes through the randomised test, too."""

    @field_validator('participants', mode='plain')
    @classmethod
    def _real_or_simulated(cls, content: Any) -> Simulated | People:
        kind = People if isinstance(content, dict) and 'real' in content else Simulated
        return kind.model_validate(content)

    @field_validator('conditions', mode='before')
    @classmethod
    def _named_as_the_preset(cls, content: Any) -> Any:
        if not isinstance(content, dict):
            return content
        return {name: {'preset': name, **(settings or {})} if isinstance(settings, dict | None) else settings
                for name, settings in content.items()}

    @model_validator(mode='after')
    def _who_ends_before_a_checkpoint_is_tested(self) -> 'PlanFile':
        if self.checkpoints and 'randomized' not in self.tests:
            raise ValueError('checkpoints: a run that ends before one counts there by its last test: add randomized to '
                             'tests, or leave checkpoints out')
        return self

    @model_validator(mode='after')
    def _tutors_know_the_tasks(self) -> 'PlanFile':
        if isinstance(self.participants, Simulated):
            for name, learning in self.conditions.items():
                task = preset_for(learning.task, learning.preset).task
                if learning.taught and not can_teach(task):
                    raise ValueError(f'conditions.{name}: simulated tutors do not know the axes of the task '
                                     f'{task.name}: let real participants teach it, or set taught to false')
        return self


class _Loader(StrictLoader):
    """YAML without aliases: plans need none, and a few of them can stand for more than a memory holds."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            raise ValueError(f'line {self.peek_event().start_mark.line + 1}: aliases (*name) are not for plans')
        return super().compose_node(parent, index)


QUICK_EPISODES, QUICK_GROUPS = 3, 2
"""How much of a plan its quick form has, at most."""


def quick(text: bytes) -> bytes:
    """A plan of minutes, to see whether all of it runs: a participant of each of the first groups, three episodes.

    Raises:
        ValueError, yaml.YAMLError, RecursionError: it is no plan, or not of simulated participants.
    """
    plan = parse(text)
    if isinstance(plan.participants, People):
        raise ValueError('--quick is for simulated participants; these are real')
    groups = list(plan.participants.simulated)[:QUICK_GROUPS]
    content = plan.model_dump(exclude={'participants'})
    content['participants'] = {**plan.participants.model_dump(), 'simulated': dict.fromkeys(groups, 1)}
    for condition in content['conditions'].values():
        condition['episodes'] = condition['evaluate_every'] = min(condition['episodes'], QUICK_EPISODES)
    return yaml.safe_dump({**content, 'tests': ['randomized'], 'checkpoints': []}, sort_keys=False).encode()


def parse(text: bytes) -> PlanFile:
    """The content of a plan's file.

    Raises:
        ValueError, yaml.YAMLError, RecursionError: it is none.
    """
    if len(text) > SIZE_MAX:
        raise ValueError(f'more than {SIZE_MAX} bytes are no plan')
    return PlanFile.model_validate(yaml.load(text, _Loader))
