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

"""Fixtures: a plant that takes no time, and a policy that balances."""

import numpy as np
import pytest
from shared_control.plant import PlantInterrupted, PlantState
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE

__all__ = ['fake_plant', 'good_robot']


class FakePlant:
    """A ball that rolls as the moment says; a person who holds ``human`` N m. Quick."""

    def __init__(self, human=0.0, falls_at=None, interrupted_at=None):
        self.spec = panda()
        self.human, self.falls_at, self.interrupted_at = human, falls_at, interrupted_at

    def reset(self, seed):
        self._x = float(np.random.default_rng(seed).uniform(-0.6, -0.3))
        self._v, self._step = 0.0, 0
        return self._state(np.zeros(1))

    def advance(self, agent):
        self._step += 1
        if self._step == self.interrupted_at:
            self.interrupted_at = None
            raise PlantInterrupted('gone')
        self._v = float(np.clip(self._v + 0.02 * 0.05 * (agent[0] + self.human), -0.5, 0.5))
        self._x += 0.02 * self._v
        return self._state(agent)

    def _state(self, agent):
        z = 0.0 if self._step == self.falls_at else 0.94
        return PlantState(
            self.spec.home, (self._x, 0.0, z), (self._v, 0.0, 0.0), np.array([self.human]), agent,
            agent + self.human)

    def close(self):
        pass


@pytest.fixture
def fake_plant():
    """The class of a plant that takes no time."""
    return FakePlant


@pytest.fixture
def good_robot():
    """A policy that tilts the tray as a spring and a damper would."""
    def act(observation):
        error, velocity, _ = observation * BALANCE.observation_scales
        m_y = -2.1 + (0.6 * error - 0.45 * velocity) / 0.008
        return np.clip([m_y / BALANCE.action_scale], -1, 1)

    return act
