"""Fixtures of this folder."""

import pytest
from shared_control.robot.model import RobotModel
from shared_control_sim.bullet import BulletWorld
from shared_control_testing.plants import *  # noqa: F403


@pytest.fixture(scope='module')
def model():
    return RobotModel()


@pytest.fixture(scope='module')
def world():
    world = BulletWorld()
    yield world
    world.close()
