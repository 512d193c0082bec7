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

"""Ways of sharing: what of the person's and of the agent's moment counts. Quick to load, for options."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

WAYS = ('additive', 'override', 'blend', 'axes')
"""``additive``: both count (the thesis, 3.3). ``override``: while the person holds a moment, it alone counts (as in
HG-DAgger, HIL-SERL and LeRobot). ``blend``: while the person holds a moment, the two are weighed (policy blending,
Dragan and Srinivasa, 2013). ``axes``: the person has the task's first axis, the robot the others (Shafti et al., 2020).
"""
PERSONS_WEIGHT = 0.5
"""The person's weight in ``blend``, unless another is set."""


@dataclass(frozen=True)
class Sharing:
    """What becomes of the two moments before they are summed: the same in one process and in the controller.

    Raises:
        ValueError: there is no such way, or the weight is not within 0..1; the message says what is expected.
    """

    way: str = 'additive'
    """One of ``WAYS``."""
    weight: float = PERSONS_WEIGHT
    """The person's, in ``blend``, 0..1."""

    def __post_init__(self) -> None:
        if self.way not in WAYS:
            raise ValueError(f'no way of sharing {self.way!r}; there are {", ".join(WAYS)}')
        if not 0.0 <= self.weight <= 1.0:
            raise ValueError(f"the person's weight is {self.weight}, expected 0 to 1")

    def check(self, axes: int) -> None:
        """Whether a task with so many axes can be shared like this.

        Raises:
            ValueError: it has one axis, and that cannot be divided.
        """
        if self.way == 'axes' and axes < 2:
            raise ValueError('axes are divided between person and robot only where a task has two: choose another task '
                             f'(plate), or another way of sharing ({", ".join(way for way in WAYS if way != "axes")})')

    def parts(self, agent: 'np.ndarray', human: 'np.ndarray') -> 'tuple[np.ndarray, np.ndarray]':
        """What counts of the agent's and of the human's moment; all (k,), N m."""
        if self.way == 'axes':
            agent, human = agent.copy(), human.copy()
            agent[0] = human[1:] = 0.0
            return agent, human
        if self.way == 'additive' or not human.any():
            return agent, human
        if self.way == 'override':
            return 0.0 * agent, human
        return (1.0 - self.weight) * agent, self.weight * human


ADDITIVE = Sharing()
