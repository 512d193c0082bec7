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

"""What the options of a session say."""

import json
import math
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from shared_control.control.sharing import WAYS, Sharing
from shared_control.plugins import LEARNERS, TASKS, WORLDS, load, names
from shared_control.teaching.feedback import FEEDBACK
from shared_control.teaching.tutors import TUTOR_NAMES

TUTORS = ('keyboard', 'page', 'sim', 'none')
EPISODES_OF_SIMULATED = 20
"""A simulated tutor teaches so many when nothing else is asked for: it cannot say that the robot has learned it."""
SIMULATED = 'simulated: '
"""Before the profile, where settings.json names a simulated tutor."""
FIXED = ('task', 'preset', 'physics', 'robot', 'seed')
"""What a session that goes on cannot change: the learner was made with it, and in it."""


@dataclass(frozen=True)
class Settings:
    """What is taught, by whom, and for how long. The ranges are those of the nodes' parameters.

    Raises:
        ValueError: a value is none that a session can run with; the message names the option.
    """

    task: str = ''
    """What is learned; empty: what the preset was made for."""
    preset: str = ''
    """How it is learned; empty: as the task is."""
    physics: str = 'bullet'
    """What the arm moves in (entry point of the group ``shared_control.worlds``)."""
    tutor: str = 'keyboard'
    """Who teaches: one of ``TUTORS``."""
    profile: str = 'expert'
    """Who the simulated tutor is: a profile, or a family, of which the seed draws one."""
    episodes: int = 0
    """Teach this many; 0: until somebody says that it has learned it."""
    minutes: float = 45.0
    """Teach for this long at the most, min."""
    test_episodes: int = 20
    """Tests of the policy alone, at the end."""
    robot: str = ''
    """The robot, by name or by the path of its file; empty: as the parameter file says."""
    seed: int = 0
    """Seed of ball starts, learner and simulated tutor."""
    page: tuple[str, int] = ('127.0.0.1', 8088)
    """Host and port of the page; port 0: any that is free."""
    sharing: str = 'additive'
    """What counts of the two moments: one of ``WAYS``."""
    screen: bool = True
    """Whether to show the lesson in the terminal."""
    blind: bool = False
    """Whether the person is told neither condition and folder nor what came of the session."""
    feedback: str = 'full'
    """What a person is told while they teach: one of ``FEEDBACK``."""
    verdicts: bool = True
    """Whether a person is offered to call an episode good, bad or discarded."""
    practice_rests: int = 0
    """Practice until the ball has been brought to rest so often; 0: until the person wants to teach."""
    practice_minutes: float = 5.0
    """Practice for this long at the most to come to that, min."""
    earlier_tutors: tuple[str, ...] = ()
    """Who taught the earlier parts of a session that went on with another tutor, as settings.json names them."""
    taught: bool = False
    """Whether the teaching came to its end, so that only the test may be left to do."""

    def __post_init__(self) -> None:
        for option, value, choices in (('--task', self.task, ('', *names(TASKS))),
                                       ('--preset', self.preset, ('', *names(LEARNERS))),
                                       ('--physics', self.physics, names(WORLDS)),
                                       ('--tutor', self.tutor, TUTORS),
                                       ('--profile', self.profile, TUTOR_NAMES), ('--sharing', self.sharing, WAYS),
                                       ('--feedback', self.feedback, FEEDBACK)):
            if value not in choices:
                raise ValueError(f'{option} has no choice {value!r}; there are {", ".join(choices)}')
        if self.robot:
            from shared_control.robot.spec_file import load_robot  # late: `--help` need not wait for numpy
            try:
                load_robot(self.robot)
            except ValueError as error:
                raise ValueError(f'--robot: {error}') from error
        for option, number, low, high in (
                ('--episodes', self.episodes, 0, 100_000), ('--minutes', self.minutes, 0.1, 1440.0),
                ('--test-episodes', self.test_episodes, 0, math.inf),
                ('--practice-rests', self.practice_rests, 0, 100),
                ('--practice-minutes', self.practice_minutes, 0.1, 60.0), ('--seed', self.seed, 0, 2**31 - 1),
                ("--page's port", self.page[1], 0, 65535)):
            if not (low <= number <= high and math.isfinite(number)):
                upper = f' and at most {high}' if high < math.inf else ''
                raise ValueError(f'{option} must be at least {low}{upper}, not {number}')

    @property
    def teacher(self) -> str:
        """The tutor as settings.json names it: a simulated one with its profile."""
        return f'{SIMULATED}{self.profile}' if self.tutor == 'sim' else self.tutor

    def resolved(self) -> 'Settings':
        """These settings with task and preset by name, and a robot's file where it is found from anywhere.

        Raises:
            ValueError: the preset cannot learn the task, or its moments cannot be shared like this.
            NotInstalled: the physics is not there.
        """
        from shared_control.robot.spec_file import is_path  # late: `--help` need not wait for numpy and pinocchio
        from shared_control_learning.presets import preset_for
        chosen = preset_for(self.task, self.preset)
        chosen.check(Sharing(self.sharing))
        load(WORLDS, self.physics)
        robot = str(Path(self.robot).expanduser().absolute()) if is_path(self.robot) else self.robot
        return replace(self, task=chosen.task.name, preset=chosen.name, robot=robot)

    def with_options(self, given: dict[str, Any]) -> 'Settings':
        """These settings with the options that were given, some of which mean nothing without another.

        Raises:
            ValueError: see the class; or an option belongs to another tutor.
        """
        if given.get('blind'):
            given = {'feedback': 'ball', 'verdicts': False, **given}
        changed = replace(self, **given)
        for name, tutor in (('profile', 'sim'), ('page', 'page')):
            if name in given and changed.tutor != tutor:
                raise ValueError(f'--{name} belongs to --tutor {tutor}, and the tutor is {changed.tutor}')
        return changed

    def resumed_with(self, given: dict[str, Any]) -> 'Settings':
        """These settings for a session that goes on, with the options that were given now.

        Raises:
            ValueError: see :meth:`with_options`; or one of ``FIXED`` was given.
        """
        for name in FIXED:
            if name in given:
                raise ValueError(f'--{name} cannot change in a session that goes on (it is {getattr(self, name)}): '
                                 'leave it out, or begin a new session')
        changed = self.with_options(given)
        if changed.teacher == self.teacher:
            return changed
        return replace(changed, earlier_tutors=(*self.earlier_tutors, self.teacher))

    def to_json(self) -> dict[str, Any]:
        """As settings.json has it."""
        content = asdict(self)
        del content['profile']
        return {**content, 'tutor': self.teacher}

    @classmethod
    def from_json(cls, content: dict[str, Any]) -> 'Settings':
        """From settings.json; what is missing has its default, and a whole number may stand for one with a point.

        Raises:
            ValueError: a value cannot be used; the message names it.
        """
        from pydantic import TypeAdapter, ValidationError  # late: `--help` need not wait for it
        from shared_control_learning.wrong_content import what_is_wrong
        known = {field.name for field in fields(cls)}
        values: dict[str, Any] = {name: value for name, value in content.items() if name in known}
        tutor = str(values.get('tutor', cls.tutor))
        if tutor.startswith(SIMULATED):
            values |= {'tutor': 'sim', 'profile': tutor.removeprefix(SIMULATED)}
        try:
            return TypeAdapter(cls).validate_json(json.dumps(values), strict=True)
        except ValidationError as error:
            raise ValueError(what_is_wrong(error)) from error
