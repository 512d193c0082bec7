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
