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

"""The simulated worlds: physics of the ball, determinism, disturbances."""

import numpy as np
import pytest
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.plugins import WORLDS, load
from shared_control.robot.model import GRAVITY, pitch
from shared_control.tasks.balance import BALANCE


@pytest.fixture
def world(physics):
    world = load(WORLDS, physics)()
    yield world
    world.close()


FIVE = np.array([5.0])


def start(x):
    """A ball above the middle of the tray's width."""
    return np.array([x, *BALANCE.scene.home[1:]])


def run(world, model, ball_x, moments):
    """States of an episode with one moment a tick."""
    controller = ComputedTorqueController(model)
    world.reset(start(ball_x))
    trace = []
    for m_y in moments:
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, np.array([m_y])))
        trace.append([*q, *qd, *world.ball_state()[0], *world.ball_state()[2]])
    return np.array(trace)


def test_ball_rolls_at_five_sevenths_of_g_sin_theta(world, model):
    """A solid sphere that rolls without slipping: a = 5/7 g sin(theta), on a tray tilted and then held."""
    controller = ComputedTorqueController(model)
    world.reset(start(-0.6))
    for tick in range(1200):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, np.array([5.0])))
        if tick == 599:
            early = world.ball_state()[2], pitch(model.tray_pose(world.joint_state()[0])[1])
    (v0, *_), pitch0 = early
    v1 = world.ball_state()[2][0]
    pitch1 = pitch(model.tray_pose(world.joint_state()[0])[1])
    acceleration = (v1 - v0) / 0.6
    assert acceleration == pytest.approx(5 / 7 * GRAVITY * np.sin((pitch0 + pitch1) / 2), rel=0.03)


def test_left_moment_rolls_the_ball_towards_positive_x(world, model):
    left = run(world, model, -0.485, [5.0] * 500)
    right = run(world, model, -0.485, [-8.0] * 500)
    assert left[-1, 14] > -0.47 and right[-1, 14] < -0.49


def test_an_episode_does_not_depend_on_what_came_before(world, model):
    moments = 6.0 * np.sin(np.arange(1500) / 100)
    first = run(world, model, -0.5, moments)
    run(world, model, -0.3, np.full(700, 15.0))
    world.push(np.array([0.0, 0.0, 50.0]))
    world.step_braked()
    again = run(world, model, -0.5, moments)
    np.testing.assert_array_equal(first, again)


def test_two_worlds_agree_bit_for_bit(world, model):
    other = type(world)()
    moments = 8.0 * np.cos(np.arange(1000) / 70)
    np.testing.assert_array_equal(run(world, model, -0.4, moments), run(other, model, -0.4, moments))
    other.close()


def test_walls_keep_a_slow_ball_and_lose_a_fast_one(world, model):
    slow = run(world, model, -0.3, [5.0] * 2000)
    assert slow[-1, 16] > 0.9
    fast = run(world, model, -0.6, [60.0] * 2500)
    assert fast[:, 16].min() < 0.836


def test_brakes_hold_the_arm(world):
    q, _ = world.joint_state()
    for _ in range(500):
        world.step_braked()
    np.testing.assert_allclose(world.joint_state()[0], q, atol=1e-3)


def test_a_push_moves_the_tray_and_ends(world, model):
    controller = ComputedTorqueController(model)
    world.reset(start(-0.485))
    height = []
    for tick in range(1000):
        world.push(np.array([0.0, 0.0, -50.0 if tick < 500 else 0.0]))
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, np.zeros(1)))
        height.append(model.tray_pose(q)[0][2])
    assert height[499] < height[0] - 0.003
    assert height[-1] > height[499] + 0.001


def test_the_ball_turns_as_one_that_rolls(world, model):
    """Its angular velocity stands in the base frame, whichever way up it is by then."""
    run(world, model, -0.485, [5.0] * 600)
    (v, *_), spin = world.ball_state()[2:]
    assert v > 0.05
    rolling = v / BALANCE.scene.ball.radius
    np.testing.assert_allclose(spin, [0.0, rolling, 0.0], atol=0.05 * rolling)


def test_the_worlds_move_alike(model):
    """The same moments and pushes, without a ball on the tray and with one that does not reach the walls."""
    traces = {}
    for name in ('bullet', 'mujoco'):
        world, controller = load(WORLDS, name)(), ComputedTorqueController(model)
        for ball in (2.0, -0.485):
            world.reset(start(ball))
            trace = traces.setdefault((name, ball), [])
            for tick in range(900):
                world.push(np.array([30.0, 20.0, -40.0]) * (ball == 2.0 and 300 <= tick < 600))
                q, qd = world.joint_state()
                world.step(controller.torque(q, qd, world.effort, FIVE))
                trace.append([*q, *world.ball_state()[0]])
        world.close()
    alone, carrying = (np.abs(np.array(traces['bullet', ball]) - traces['mujoco', ball]) for ball in (2.0, -0.485))
    assert alone[:, :7].max() < 1e-6  # PyBullet knows where the tray is a tick late
    assert carrying[:, :7].max() < 5e-4 and carrying[:, 7:].max() < 1e-3
