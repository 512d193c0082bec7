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

"""Fixtures of this folder."""

import pytest
from shared_control.plugins import WORLDS, load
from shared_control.robot.model import RobotModel
from shared_control_testing.plants import *  # noqa: F403


@pytest.fixture(scope='module')
def model():
    return RobotModel()


@pytest.fixture(scope='module', params=['bullet', 'mujoco'])
def physics(request):
    """Each of our own worlds, by name: what is tested with it holds in both."""
    return request.param


@pytest.fixture(scope='module')
def world(physics):
    world = load(WORLDS, physics)()
    yield world
    world.close()
