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

"""Who a simulated person of a family is."""

from dataclasses import dataclass
from typing import Literal

LawName = Literal['reactive', 'crossover', 'intermittent', 'bang_bang', 'surge', 'blind', 'contrary',
                  'opposed']
Habit = Literal['hold', 'tap', 'forget']


@dataclass(frozen=True)
class Individual:
    """Everything that makes one simulated person; drawn by :mod:`shared_control.teaching.families`."""

    family: str
    law: LawName
    delay: float
    """Median of the time from the world to the hand, s."""
    delay_spread: float
    """Standard deviation of its logarithm, from look to look and drifting."""
    position_noise: float
    """Standard deviation of the position as seen, m."""
    velocity_noise: float
    """m/s"""
    dead_band: float
    """Nearer than this the ball is where it should be, to this person, m; an intermittent one is not surprised
    by less."""
    stiffness: float
    """Tilt for each metre, rad/m; the crossover frequency, rad/s, to the law of that name."""
    lead: float
    """How far ahead velocity is counted on, s."""
    strength: int
    """Keystrokes of a push, for laws that push."""
    rhythm: float
    """Refractory time, wait after a surge, or time between two changes of mind, s."""
    key_rate: float
    """Most key presses a second, 1/s."""
    habit: Habit
    """``hold`` keeps a moment until another is wanted, ``tap`` lets go again at once, ``forget`` leaves it."""
    tap_seconds: float
    """How long a tap lasts, s."""
    forgets: float
    """Probability that a moment that is no longer wanted stays, for who forgets."""
    lapses: float
    """Lapses of attention in a minute, 1/min: nothing is pressed, what is held stays."""
    lapse_seconds: float
    """Mean length of one, s."""
    wrong_keys: float
    """Probability that a press hits another key."""
    fatigue: float
    """Part by which delay and lapses grow with each episode."""
    learns_within: int
    """Episodes in which a novice's delay and wrong keys, at first twice as many, come down to these figures."""
    hands_over: bool
    """Whether they leave more to a robot that does well; who does not helps for ever."""
