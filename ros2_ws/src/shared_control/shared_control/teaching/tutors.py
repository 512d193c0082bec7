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

"""Simulated tutors by name: the profiles, and the families of which an individual is drawn.

Quick to load, for options and launch files: what looks at a robot is imported when a tutor is made.
"""

from typing import TYPE_CHECKING

from .families import FAMILIES, draw_individual
from .individual import Individual
from .profiles import PROFILES, TutorProfile, profile

if TYPE_CHECKING:
    from ..tasks.task import Task
    from .person import SimulatedPerson

Who = TutorProfile | Individual
"""A simulated person as a frozen dataclass of numbers."""

TUTOR_NAMES = (*PROFILES, *FAMILIES)
"""What a tutor may be called in options, plans and parameters."""


def tutor_named(name: str, seed: int = 0) -> Who:
    """The profile called ``name``, or the individual of that family that belongs to ``seed``.

    Raises:
        ValueError: there is neither; the message lists the names.
    """
    if name not in TUTOR_NAMES:
        raise ValueError(f'no simulated tutor {name!r}; there are {", ".join(TUTOR_NAMES)}')
    return profile(name) if name in PROFILES else draw_individual(name, seed)


HANDS = ('keys', 'stick')
"""What a simulated person may have in the hand."""


def make_tutor(who: Who, task: 'Task', seed: int = 0, episodes: int = 0, hand: str = HANDS[0]) -> 'SimulatedPerson':
    """Someone at the keys, or at a stick.

    Args:
        who: a profile or an individual.
        task: its axes and keys.
        seed: of what differs from look to look.
        episodes: taught before.
        hand: what is in it, of :data:`HANDS`; a profile knows keys alone.

    Raises:
        ValueError: the task has other axes than tutors know, or a profile is to have a stick.
    """
    from .individual_tutor import IndividualTutor
    from .stick_tutor import StickTutor
    from .tutor import SimulatedTutor
    if isinstance(who, TutorProfile):
        if hand != 'keys':
            raise ValueError(f'profiles, and the family predictive, know keys alone: a {hand} is for other families')
        return SimulatedTutor(who, seed, episodes, task)
    return (StickTutor if hand == 'stick' else IndividualTutor)(who, seed, episodes, task)
