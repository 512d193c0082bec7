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

"""The controller: implicit PD, limits, gravity."""

import numpy as np
import pytest
from shared_control.control.computed_torque import ComputedTorqueController, limit_torque
from shared_control.robot.model import pitch
from shared_control.robot.possible import BEYOND_LIMITS, TIMES_AS_FAST, TIMES_AS_STRONG, PossibleStates
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE

DT = 0.001
FAR = np.full(panda().dof, 1e9)
FIVE = np.array([5.0])
HOME = np.array(BALANCE.scene.home)


def unlimited(controller, q, qd, m_y, **reference):
    """The torque before limits: asked for from everywhere at once, it is where the two bounds meet."""
    controller._rate = np.inf
    return controller.torque(q, qd, np.zeros(panda().dof), np.atleast_1d(m_y), **reference)


def test_implicit_pd_solves_its_equation(model):
    """tau_pd = K_p (q_ref - q - qd dt) + K_d (qd_ref - qd - a dt), a the acceleration that this torque causes."""
    random = np.random.default_rng(0)
    gains = panda().gains['low']
    for _ in range(10):
        q = panda().home + random.normal(0, 0.002, panda().dof)
        qd = random.normal(0, 0.002, panda().dof)
        m_y = random.uniform(-2, 2)
        torque = unlimited(ComputedTorqueController(model, gains='low'), q, qd, m_y)
        nonlinear = model.nonlinear_effects(q, qd).copy()
        acceleration = np.linalg.solve(model.mass_matrix(q), torque - nonlinear)
        tau_pd = gains.kp * (panda().home - q - qd * DT) - gains.kd * (qd + acceleration * DT)
        expected = tau_pd + model.jacobian(q).T @ [0, 0, 0, 0, m_y, 0] + nonlinear
        np.testing.assert_allclose(torque, expected, atol=1e-9)


def test_a_moment_along_other_axes_is_refused(model):
    with pytest.raises(ValueError, match='2 numbers for 1 axes'):
        ComputedTorqueController(model).torque(panda().home, np.zeros(7), np.zeros(7), np.zeros(2))


def test_holds_still_at_the_reference(model):
    torque = ComputedTorqueController(model).torque(
        panda().home, np.zeros(panda().dof), model.gravity(panda().home).copy(), np.zeros(1))
    np.testing.assert_allclose(torque, model.gravity(panda().home), atol=1e-12)


def test_gravity_is_left_to_a_robot_that_compensates_it(model):
    qd = np.full(panda().dof, 0.001)
    whole = ComputedTorqueController(model)
    without = ComputedTorqueController(model, robot_compensates_gravity=True)
    difference = unlimited(whole, panda().home, qd, 1.0) - unlimited(without, panda().home, qd, 1.0)
    np.testing.assert_allclose(difference, model.gravity(panda().home), atol=1e-9)


def test_torque_and_its_rate_are_limited():
    previous = np.zeros(panda().dof)
    np.testing.assert_array_equal(limit_torque(panda(), FAR, previous, 1.0), np.ones(panda().dof))
    np.testing.assert_array_equal(limit_torque(panda(), -FAR, panda().torque_max - 0.5, 1.0), panda().torque_max - 1.5)
    np.testing.assert_array_equal(limit_torque(panda(), FAR, panda().torque_max - 0.5, 1.0), panda().torque_max)


@pytest.mark.parametrize('sign', [-1.0, 1.0])
def test_every_possible_state_has_a_torque_within_the_limits(model, sign):
    spec = panda()
    state = (sign * (spec.q_max + BEYOND_LIMITS - 1.0), sign * TIMES_AS_FAST * spec.qd_max,
             sign * TIMES_AS_STRONG * spec.torque_max)
    assert PossibleStates(spec).fault(*state) == ''
    torque = ComputedTorqueController(model, compensate_nonlinear=False).torque(*state, FIVE)
    assert (np.abs(torque) <= spec.torque_max).all()


@pytest.mark.parametrize('gains', panda().gains)
def test_all_gains_are_stable_on_the_simulated_arm(model, world, gains):
    """An explicit PD shakes the arm to its torque limits with each of these."""
    controller = ComputedTorqueController(model, gains=gains)
    world.reset(HOME)
    for tick in range(1500):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, FIVE if tick < 300 else 0.0 * FIVE))
    q, qd = world.joint_state()
    assert np.abs(qd).max() < 0.05
    assert np.abs(q - panda().home).max() < 0.1


def test_a_keystroke_tilts_the_tray_as_measured(model, world):
    """5 N m: 2.3 degrees quickly, creeping to 3.3 in 3 s."""
    controller = ComputedTorqueController(model)
    world.reset(HOME)
    tilt = {}
    for tick in range(3000):
        q, qd = world.joint_state()
        tilt[tick] = np.rad2deg(pitch(model.tray_pose(q)[1]))
        world.step(controller.torque(q, qd, world.effort, FIVE))
    assert tilt[200] == pytest.approx(2.3, abs=0.15)
    assert tilt[2999] == pytest.approx(3.3, abs=0.15)
