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

"""What an environment acts on: arm, tray and ball under control, for one policy period at a time."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .robot.spec import RobotSpec


@dataclass(frozen=True, eq=False)
class PlantState:
    """The plant at a policy tick, base frame, SI units."""

    q: np.ndarray
    """Joint positions, (n,), rad"""
    ball_position: tuple[float, ...]
    """(3,), m"""
    ball_velocity: tuple[float, ...]
    """(3,), m/s"""
    human: np.ndarray
    """The human's moment as it counted over the period that ended here, along the task's axes, (k,), N m"""
    agent: np.ndarray
    """The agent's, likewise"""
    applied: np.ndarray
    """Their sum as applied, likewise"""


class PlantInterrupted(RuntimeError):
    """The plant went away in mid-episode (a node was restarted): the episode is void, learning is not."""


class Plant(Protocol):
    """A plant in this process, or one reached through topics."""

    spec: RobotSpec
    """The robot."""

    def reset(self, seed: int | None) -> PlantState:
        """Start an episode; a ``seed`` begins the sequence of ball starts anew."""

    def advance(self, agent: np.ndarray) -> PlantState:
        """Apply the agent's moment, (k,), N m, for one policy period.

        Raises:
            PlantInterrupted: the episode cannot go on.
        """

    def close(self) -> None:
        """Let go of everything."""
