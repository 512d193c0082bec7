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

"""The practice before a lesson: how often the ball has been brought to rest, and whether that is enough."""

from dataclasses import dataclass

from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.task import Task

PRACTICE_NAME = 'practice.json'
"""What the person achieved, beside the policy."""
REST_SECONDS = 3.0
"""How long the ball has to stay at the goal to count as brought to rest, s."""


@dataclass
class Practice:
    """Counts what a person alone achieves; :meth:`step` once a policy period.

    Args:
        task: whose goal it is, and within which radius.
        wanted: how often the ball is to be brought to rest; 0: there is no criterion.
        seconds_max: after this the practice is enough in any case, s of the robot's time.
    """

    task: Task
    wanted: int
    seconds_max: float
    rests: int = 0
    seconds: float = 0.0
    _resting: float = 0.0

    def step(self, position_error: float) -> bool:
        """Whether the ball has just been brought to rest, which is then counted.

        Args:
            position_error: the task's, m.
        """
        self.seconds += POLICY_PERIOD
        is_there = abs(position_error) <= self.task.scene.goal_radius
        self._resting = self._resting + POLICY_PERIOD if is_there else 0.0
        if self._resting < REST_SECONDS - POLICY_PERIOD / 2:
            return False
        self.rests += 1
        self._resting = 0.0
        return True

    def begin(self) -> None:
        """A ball is dropped anew."""
        self._resting = 0.0

    @property
    def left(self) -> int:
        """How often it still has to be; 0 once that, or the time, is enough."""
        return 0 if self.seconds >= self.seconds_max else max(self.wanted - self.rests, 0)

    def as_dict(self) -> dict[str, float | bool]:
        """For ``practice.json``."""
        return {'rests': self.rests, 'wanted': self.wanted, 'met': self.rests >= self.wanted,
                'seconds': round(self.seconds, 2)}
