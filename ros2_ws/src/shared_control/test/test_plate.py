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

"""Plate and detour: what they see, reward and take for success."""

import math
from dataclasses import replace

import numpy as np
import pytest
from shared_control.plant import PlantState
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import Plate, PlateState
from shared_control.tasks.task import BallStarts

STATE = PlateState(ball=(0.03, -0.04), ball_velocity=(0.15, 0.0), lean=(0.05, -0.025), height=0.021,
                   position_error=0.05, manipulability=0.07)


def test_the_learner_sees_both_axes():
    np.testing.assert_allclose(Plate().observe(STATE), [-0.3, 0.4, 1.0, 0.0, 1.0, -0.5], rtol=1e-6)


def test_reward_by_hand():
    error = 0.05 ** 2 / 0.0642
    tilt = math.asin(math.hypot(0.05, 0.025))
    assert Plate().reward_terms(STATE) == pytest.approx({
        'R_alpha': -tilt ** 2, 'R_V': -0.333 * 0.15 ** 2, 'R_P': -10 * error, 'R_Pe': math.exp(-20 * error)})


def test_a_ball_below_the_surface_is_lost():
    lost = replace(STATE, height=-0.001)
    assert Plate().failed(lost) and not Plate().failed(STATE)
    assert Plate().reward_terms(lost) == {'fall': -5000.0}


def test_the_plate_is_described_in_its_own_frame():
    q = panda().home
    model = RobotModel()
    position, rotation = (part.copy() for part in model.tray_pose(q))
    ball = position + rotation @ [0.06, 0.08, 0.021]
    none = np.zeros(2)
    state = Plate().describe(PlantState(q, tuple(ball), (0.3, 0.4, 0.0), none, none, none), model)
    assert state.ball == pytest.approx((0.06, 0.08)) and state.height == pytest.approx(0.021)
    assert state.position_error == pytest.approx(0.1) and state.velocity == pytest.approx(0.5)
    assert state.lean == pytest.approx((math.sin(math.radians(1.0)), 0.0))
    around = Detour().describe(PlantState(q, tuple(ball), (0.3, 0.4, 0.0), none, none, none), model)
    assert around.position_error == pytest.approx(0.12)


@pytest.mark.parametrize('task', [Plate(), Detour()])
def test_balls_are_dropped_clear_of_walls_and_bar(task):
    starts = BallStarts(task, 5)
    radius = task.scene.ball.radius
    drops = np.array([starts.next() for _ in range(500)]) - task.scene.home
    assert np.abs(drops[:, :2]).max() < task.scene.half_length - radius
    for box in task.scene.boxes:
        if box.is_obstacle:
            inside = np.abs(drops[:, :2] - box.centre[:2]) < np.array(box.size[:2]) / 2 + radius
            assert not inside.all(axis=1).any()
    assert len(np.unique(drops[:, 1])) == 500


def test_the_way_points_lead_round_the_bar():
    """Straight lines from way-point to way-point, clear of the bar by more than the ball's radius."""
    task = Detour()
    bar = next(box for box in task.scene.boxes if box.is_obstacle)
    half = np.array(bar.size[:2]) / 2 + task.scene.ball.radius
    starts = BallStarts(task, 6)
    for _ in range(50):
        ball = (starts.next() - task.scene.home)[:2]
        for _ in range(500):
            step = task.aim(ball) - ball
            ball = ball + step * min(1.0, 0.002 / max(float(np.linalg.norm(step)), 1e-9))
            assert not (np.abs(ball - bar.centre[:2]) < half).all()
        assert np.linalg.norm(ball - task.scene.goal) < 1e-6


def test_success_is_rest_at_the_goal():
    near, still = np.full(750, 0.02), np.full(750, 0.01)
    assert Detour().succeeded(near, still, False) and not Detour().succeeded(near, still, True)
    assert not Plate().succeeded(near + 0.005, still, False) and not Detour().succeeded(near, still + 0.03, False)


@pytest.mark.parametrize(('name', 'value'), [
    ('action_scale', 0.0), ('weight_tilt', -1.0), ('fall_reward', 1.0), ('reward_scale', math.inf)])
def test_settings_that_cannot_be_are_refused(name, value):
    with pytest.raises(ValueError, match=name):
        replace(Plate(), **{name: value})
