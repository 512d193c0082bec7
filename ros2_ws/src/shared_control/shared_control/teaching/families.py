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

"""The population of simulated tutors: families from the literature of manual control, of which individuals are drawn.

Settings of learners are chosen on the families marked ``TUNING`` alone; what is reported as a result is of ``HELD_OUT``
ones. This is the one place that says which is which.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from enum import Enum
from typing import TYPE_CHECKING, get_args

from .individual import Habit, Individual, LawName
from .profiles import EXPERT, TutorProfile

if TYPE_CHECKING:
    import numpy as np


class Use(Enum):
    """What a family is for."""

    TUNING = 'tuning'
    """Settings may be chosen on it."""
    HELD_OUT = 'held out'
    """For reports alone: no setting has been chosen on it."""
    CONTROL = 'control'
    """Does not help, and is not meant to: what must not do harm."""


@dataclass(frozen=True)
class Family:
    """A kind of simulated tutor."""

    name: str
    use: Use
    about: str
    source: str
    draw: Callable[['np.random.Generator'], Individual | TutorProfile]


def spread_around(profile: TutorProfile, spread: float, random: 'np.random.Generator') -> TutorProfile:
    """An individual around ``profile``: each number times ``exp(spread z)``, z standard normal."""
    import numpy as np  # late: the names of families stand in options, whose `--help` need not wait for it
    numbers = [f.name for f in fields(profile) if type(getattr(profile, f.name)) is float]
    factors = np.exp(spread * random.standard_normal(len(numbers)))
    return replace(profile, **{name: getattr(profile, name) * float(factor)
                               for name, factor in zip(numbers, factors, strict=True)})


def _people(family: str, law: LawName, stiffness: tuple[float, float], lead: tuple[float, float],
            dead_band: tuple[float, float] = (0.015, 0.03), rhythm: tuple[float, float] = (0.25, 0.5),
            ) -> Callable[['np.random.Generator'], Individual]:
    """Draws of a family: ranges are of uniform distributions; the delay's median is log-normal (0.3 s, sigma 0.25)."""
    habits = get_args(Habit)

    def draw(random: 'np.random.Generator') -> Individual:
        def between(low: float, high: float) -> float:
            return float(random.uniform(low, high))

        return Individual(
            family, law, delay=0.3 * math.exp(0.25 * float(random.standard_normal())),
            delay_spread=between(0.1, 0.35), position_noise=between(0.003, 0.012), velocity_noise=between(0.01, 0.03),
            dead_band=between(*dead_band), stiffness=between(*stiffness), lead=between(*lead),
            strength=int(random.integers(1, 3)), rhythm=between(*rhythm), key_rate=between(3.0, 6.0),
            habit=habits[random.integers(len(habits))], tap_seconds=between(0.15, 0.4), forgets=between(0.2, 0.7),
            lapses=between(0.5, 3.0), lapse_seconds=between(0.5, 2.0), wrong_keys=between(0.01, 0.06),
            fatigue=between(0.0, 0.03), learns_within=int(random.integers(0, 6)),
            hands_over=bool(random.random() < 0.5))

    return draw


FAMILIES: dict[str, Family] = {family.name: family for family in (
    Family('predictive', Use.TUNING, 'thinks ahead, trusts, loses patience: around the profile expert',
           'internal models: Miall and Wolpert, Neural Networks, 1996',
           lambda random: spread_around(EXPERT, 0.3, random)),
    Family('bang_bang', Use.TUNING, 'pushes all the way one way, then the other; looks little ahead',
           'Young and Meiry, IEEE Trans. Automatic Control, 1965',
           _people('bang_bang', 'bang_bang', stiffness=(0.0, 0.0), lead=(0.2, 0.7))),
    Family('opposed', Use.TUNING, 'does the opposite of a bang-bang tutor: an adversary to choose settings on',
           'control condition', _people('opposed', 'opposed', stiffness=(0.0, 0.0), lead=(0.2, 0.7))),
    Family('reactive', Use.HELD_OUT, 'a spring and a damper on what is seen late, outside a dead band',
           'PD as the simplest operator: McRuer and Jex, IEEE Trans. Human Factors in Electronics, 1967',
           _people('reactive', 'reactive', stiffness=(0.3, 0.9), lead=(0.4, 0.9))),
    Family('crossover', Use.HELD_OUT, 'leads so that person and plant are an integrator with delay; remnant',
           'McRuer and Jex, IEEE Trans. Human Factors in Electronics, 1967',
           _people('crossover', 'crossover', stiffness=(1.0, 2.2), lead=(0.6, 1.5), dead_band=(0.005, 0.02))),
    Family('intermittent', Use.HELD_OUT, 'acts on surprises, ballistic in between',
           'Gawthrop, Loram, Lakie and Gollee, Biological Cybernetics, 2011',
           _people('intermittent', 'intermittent', stiffness=(0.3, 0.8), lead=(0.5, 1.0))),
    Family('surge', Use.HELD_OUT, 'pushes for a moment, waits to see what came of it',
           'Costello, IEEE Trans. Man-Machine Systems, 1968',
           _people('surge', 'surge', stiffness=(0.0, 0.0), lead=(0.3, 0.8), rhythm=(0.3, 0.8))),
    Family('blind', Use.CONTROL, 'presses keys that have nothing to do with the ball (a sham)', 'control condition',
           _people('blind', 'blind', stiffness=(0.0, 0.0), lead=(0.0, 0.0), rhythm=(0.3, 1.5))),
    Family('contrary', Use.CONTROL, 'does the opposite of a reactive tutor (an adversary)', 'control condition',
           _people('contrary', 'contrary', stiffness=(0.3, 0.9), lead=(0.4, 0.9))),
)}

_STREAM = 2
"""Keeps the draws of individuals apart from other random numbers of the same seed."""


def draw_individual(family: str, seed: int) -> Individual | TutorProfile:
    """The individual of ``family`` that belongs to ``seed``.

    Raises:
        ValueError: there is no such family; the message lists the names.
    """
    import numpy as np
    if family not in FAMILIES:
        raise ValueError(f'no family of tutors {family!r}; there are {", ".join(FAMILIES)}')
    return FAMILIES[family].draw(np.random.default_rng((seed, _STREAM)))
