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

"""A Panda behind its torque interface: reflexes, and control by torques that come late or not at all."""

import numpy as np
import pytest
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.plugins import WORLDS, load
from shared_control.robot.reflex import command_violation, state_violation
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE
from shared_control_sim.effort_arm import EffortPanda, Mode

STILL = np.zeros(7)
JUMP = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.5, 0.0])


@pytest.fixture
def world(physics):
    world = load(WORLDS, physics)()
    yield world
    world.close()


@pytest.fixture
def robot(world):
    return EffortPanda(world, limit_rate=False)


def test_every_limit_has_its_name():
    assert command_violation(panda(), STILL, STILL, 1e-3) == command_violation(panda(), JUMP, JUMP / 3, 1e-3) == ''
    too_strong = panda().torque_max * [1.01, 1, 1, 1, 1, 1, 1]
    assert 'tau_j_range_violation: panda_joint1' in command_violation(panda(), too_strong, STILL, 1.0)
    assert 'controller_torque_discontinuity' in command_violation(panda(), JUMP, STILL, 1e-3)
    assert 'the torque of panda_joint6 jumped by 1.50 N m, 1.00 are' in command_violation(panda(), JUMP, STILL, 1e-3)
    assert state_violation(panda(), panda().home, panda().qd_max) == ''
    beyond, too_fast = panda().q_max + [0, 0, 0, 0, 0, 0, 1e-3], -panda().qd_max * [1, 1, 1, 1, 1.01, 1, 1]
    assert 'joint_position_limits_violation: panda_joint7' in state_violation(panda(), beyond, STILL)
    assert 'joint_velocity_violation: panda_joint5' in state_violation(panda(), panda().home, too_fast)


def test_it_carries_its_own_weight_and_stays_within_a_millimetre_on_zero_torques(robot, world, model):
    world.reset(np.array([2.0, 0.0, 0.94]))  # beside the tray: the ball is not the robot's own weight
    for _ in range(200):
        robot.tick(STILL)
    assert robot.mode is Mode.MOVE
    height = model.tray_pose(world.joint_state()[0])[0][2]
    assert height == pytest.approx(model.tray_pose(panda().home)[0][2], abs=1e-3)


def test_a_jump_of_the_torque_makes_it_stop_until_it_is_told_to_recover(robot, world):
    robot.tick(STILL)
    robot.tick(JUMP)
    assert robot.mode is Mode.REFLEX and 'controller_torque_discontinuity' in robot.fault
    for _ in range(50):
        robot.tick(STILL)
    assert robot.mode is Mode.REFLEX
    assert np.abs(world.joint_state()[1]).max() < 1e-3, 'its brakes hold it'
    assert robot.recover() and robot.fault == ''
    assert not robot.recover()
    robot.tick(JUMP)
    assert robot.mode is Mode.IDLE, 'what it cannot reach within a tick does not start it'
    robot.tick(STILL)
    assert robot.mode is Mode.MOVE


def test_a_joint_that_is_too_fast_makes_it_stop(robot):
    torque = STILL
    for _ in range(500):
        torque = np.minimum(torque + [0, 0, 0, 0, 0, 0, 1.0], panda().torque_max)
        robot.tick(torque)
        if robot.mode is Mode.REFLEX:
            break
    assert 'joint_velocity_violation: panda_joint7' in robot.fault


def test_the_limiter_of_the_rate_approaches_what_is_far_off(world):
    robot = EffortPanda(world, limit_rate=True)
    robot.tick(STILL)
    robot.tick(JUMP)
    assert robot.mode is Mode.MOVE and robot.torque[5] == 1.0
    robot.tick(None)
    assert robot.torque[5] == 1.5 and robot.limited_ticks == 1


def test_with_its_own_weight_it_is_given_no_more_than_its_joints_have(robot, world, model):
    joint = int(np.abs(model.gravity(panda().home)).argmax())
    push = np.eye(7)[joint] * np.sign(model.gravity(panda().home)[joint])
    efforts = []
    for tick in range(52):
        robot.tick(tick * push)
        efforts.append(world.effort)
    assert robot.mode is Mode.MOVE
    assert np.abs(efforts).max() == panda().torque_max[joint]


def test_silence_ends_the_control(robot):
    robot.tick(STILL)
    for _ in range(100):
        robot.tick(None)
    assert robot.mode is Mode.MOVE
    robot.tick(None)
    assert robot.mode is Mode.IDLE


def test_late_and_lost_torques_hold_the_arm_within_its_limits(world, model):
    """Up to three ticks late, one in a hundred lost; moments that change as a policy's do."""
    random = np.random.default_rng(4)
    robot = EffortPanda(world)
    controller = ComputedTorqueController(model, horizon=0.004, robot_compensates_gravity=True)
    robot.reset(np.array(BALANCE.scene.home))
    on_their_way: list[tuple[int, np.ndarray]] = []
    for tick in range(4000):
        if tick % 20 == 0:
            m_y = -2.1 + random.normal(0.0, 1.0)
        q, qd = world.joint_state()
        if random.random() > 0.01:
            torque = controller.torque(q, qd, robot.torque, np.atleast_1d(m_y))
            on_their_way.append((tick + random.integers(0, 4), torque))
        arrived = [torque for due, torque in on_their_way if due <= tick]
        on_their_way = [(due, torque) for due, torque in on_their_way if due > tick]
        robot.tick(arrived[-1] if arrived else None)
        assert not robot.fault
        assert np.abs(q - panda().home).max() < 0.1
    assert robot.mode is Mode.MOVE
    assert robot.limited_ticks < 40, 'the limiter of the rate is for the rare case'
