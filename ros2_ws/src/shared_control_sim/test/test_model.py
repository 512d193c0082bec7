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

"""The pinocchio model: against known numbers, finite differences, PyBullet and MuJoCo."""

from dataclasses import replace

import mujoco
import numpy as np
import pybullet
import pytest
from shared_control.robot.model import RobotModel, pitch
from shared_control.robot.spec_file import panda
from shared_control_sim.bullet import BulletWorld
from shared_control_sim.mujoco_world import MujocoWorld


def random_states(count):
    random = np.random.default_rng(1)
    for _ in range(count):
        yield random.uniform(panda().q_min, panda().q_max), random.uniform(-panda().qd_max, panda().qd_max)


def test_limits_are_those_of_table_1(model):
    np.testing.assert_array_equal(model.pin_model.upperPositionLimit, panda().q_max)
    np.testing.assert_array_equal(model.pin_model.lowerPositionLimit, panda().q_min)
    np.testing.assert_array_equal(model.pin_model.velocityLimit, panda().qd_max)
    np.testing.assert_array_equal(model.pin_model.effortLimit, panda().torque_max)


def test_home_tray_is_where_the_appendix_drops_the_ball(model):
    position, rotation = model.tray_pose(panda().home)
    np.testing.assert_allclose(position, [-0.485, 0.0, 0.908], atol=5e-4)
    assert np.rad2deg(pitch(rotation)) == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(rotation[:, 1], [0, 1, 0], atol=1e-9)  # long side along base x


def test_jacobian_is_the_derivative_of_the_pose(model):
    h = 1e-6
    for q, _ in random_states(5):
        jacobian = model.jacobian(q).copy()
        for joint in range(panda().dof):
            step = np.zeros(panda().dof)
            step[joint] = h
            p1, r1 = (a.copy() for a in model.tray_pose(q + step))
            p0, r0 = (a.copy() for a in model.tray_pose(q - step))
            spin = (r1 - r0) / (2 * h) @ ((r1 + r0) / 2).T
            np.testing.assert_allclose(jacobian[:3, joint], (p1 - p0) / (2 * h), atol=1e-7)
            np.testing.assert_allclose(jacobian[3:, joint], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-7)


def test_pybullet_agrees_on_mass_matrix_gravity_and_coriolis(model):
    world = BulletWorld()
    still = [0.0] * panda().dof
    for q, qd in random_states(20):
        mass = np.array(pybullet.calculateMassMatrix(world.arm, list(q), physicsClientId=world.client))
        np.testing.assert_allclose(model.mass_matrix(q), mass, atol=1e-9)

        def inverse_dynamics(velocity, q=q):
            return np.array(pybullet.calculateInverseDynamics(
                world.arm, list(q), list(velocity), still, physicsClientId=world.client))

        gravity = inverse_dynamics(still)
        np.testing.assert_allclose(model.gravity(q), gravity, atol=1e-11)
        coriolis = model.nonlinear_effects(q, qd) - model.gravity(q)
        np.testing.assert_allclose(coriolis, inverse_dynamics(qd) - gravity, atol=1e-11)
    world.close()


def test_mujoco_agrees_on_mass_matrix_gravity_coriolis_and_tray_pose(model):
    world, n = MujocoWorld(), panda().dof
    mass = np.zeros((world.model.nv, world.model.nv))
    for q, qd in random_states(100):
        world.data.qpos[:n], world.data.qvel[:n] = q, qd
        mujoco.mj_forward(world.model, world.data)
        mujoco.mj_fullM(world.model, world.data, mass)
        np.testing.assert_allclose(model.mass_matrix(q), mass[:n, :n], atol=1e-13)
        np.testing.assert_allclose(model.nonlinear_effects(q, qd), world.data.qfrc_bias[:n], atol=1e-12)
        position, rotation = model.tray_pose(q)
        tray = world.data.body(panda().tool_frame)
        np.testing.assert_allclose(position, tray.xpos, atol=1e-13)
        np.testing.assert_allclose(rotation, tray.xmat.reshape(3, 3), atol=1e-13)


def test_manipulability_at_home(model):
    k_w = model.manipulability(panda().home)
    assert k_w == pytest.approx(0.074, abs=5e-4)
    assert 1 - k_w ** 2 == pytest.approx(0.995, abs=5e-4)


def test_another_order_of_the_joints_is_refused():
    with pytest.raises(ValueError, match='has the joints'):
        RobotModel(replace(panda(), joints=panda().joints[::-1]))


def test_joint_names_are_in_order(model):
    assert tuple(model.pin_model.names)[1:] == panda().joints
