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

"""The plate and its bar in the simulated worlds, moved by the controller about both axes."""

import numpy as np
import pytest
from shared_control.env import SharedControlEnv
from shared_control.robot.model import RobotModel
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import Plate
from shared_control_sim.local_plant import LocalPlant


@pytest.fixture
def plant(request, physics):
    made = LocalPlant(request.param, physics=physics)
    yield made
    made.close()


def roll(plant, moment, start, seconds):
    """Where the ball comes to be on the plate, dropped at ``start`` (x, y on the plate), (3,), m."""
    plant.reset(0)
    plant.world.reset(np.array([-0.4846 + start[0], start[1], 0.935]))
    for _ in range(round(seconds * 1000)):
        plant.tick(np.array(moment))
    q, _ = plant.world.joint_state()
    position, rotation = RobotModel(plant.spec).tray_pose(q)
    return rotation.T @ (np.array(plant.world.ball_state()[0]) - position)


@pytest.mark.parametrize('plant', [Plate()], indirect=True)
def test_each_moment_rolls_the_ball_along_the_other_axis(plant):
    level = (0.0, -2.1)  # the tray leans a degree at rest
    x, y, _ = roll(plant, (5.0, level[1]), (0.0, 0.0), 1.0)
    assert y < -0.04 and abs(x) < 0.03
    x, y, _ = roll(plant, (0.0, 5.0), (0.0, 0.0), 1.0)
    assert x > 0.06 and abs(y) < 0.002
    x, y, _ = roll(plant, level, (0.0, 0.0), 1.0)
    assert abs(x) < 0.03 and abs(y) < 0.002


@pytest.mark.parametrize('plant', [Plate(), Detour()], indirect=True)
def test_the_bar_stops_the_ball(plant):
    """Rolled to +y from y = -0.06."""
    _, y, height = roll(plant, (-5.0, -2.1), (-0.05, -0.06), 2.0)
    assert height == pytest.approx(0.021, abs=2e-3)
    if plant.world.spec.tool_link.count('obstacle'):
        assert y == pytest.approx(-0.005 - 0.015, abs=2e-3)
    else:
        assert y > 0.1


@pytest.mark.parametrize('plant', [Detour()], indirect=True)
def test_the_gap_lets_it_through(plant):
    _, y, _ = roll(plant, (-5.0, -2.1), (0.1, -0.06), 2.0)
    assert y > 0.1


@pytest.mark.parametrize('task', [Plate(), Detour()])
def test_episodes_repeat_to_the_bit(task, physics):
    env = SharedControlEnv(LocalPlant(task, physics=physics), task)
    tracks = []
    for _ in range(2):
        observation, _ = env.reset(seed=3)
        track = [observation]
        for step in range(100):
            observation, reward, *_ = env.step(np.array([np.sin(0.1 * step), np.cos(0.07 * step)]))
            track.append(np.append(observation, reward))
        tracks.append(np.concatenate(track))
    env.close()
    np.testing.assert_array_equal(*tracks)
