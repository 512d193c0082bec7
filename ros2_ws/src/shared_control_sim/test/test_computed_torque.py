"""The controller: implicit PD, limits, gravity."""

import numpy as np
import pytest
from shared_control.control.computed_torque import ComputedTorqueController, limit_torque
from shared_control.robot.limits import DOF, TORQUE_MAX
from shared_control.robot.model import PandaModel, pitch
from shared_control.robot.posture import GAINS, Q_REFERENCE
from shared_control.tasks.balance import BALANCE
from shared_control_sim.bullet import BulletWorld

DT = 0.001
FAR = np.full(DOF, 1e9)
FIVE = np.array([5.0])
HOME = np.array(BALANCE.scene.home)


@pytest.fixture(scope='module')
def model():
    return PandaModel()


@pytest.fixture(scope='module')
def world():
    world = BulletWorld()
    yield world
    world.close()


def unlimited(controller, q, qd, m_y, **reference):
    """The torque before limits: asked for from everywhere at once, it is where the two bounds meet."""
    controller._rate = np.inf
    return controller.torque(q, qd, np.zeros(DOF), np.atleast_1d(m_y), **reference)


def test_implicit_pd_solves_its_equation(model):
    """tau_pd = K_p (q_ref - q - qd dt) + K_d (qd_ref - qd - a dt), a the acceleration that this torque causes."""
    random = np.random.default_rng(0)
    gains = GAINS['low']
    for _ in range(10):
        q = Q_REFERENCE + random.normal(0, 0.002, DOF)
        qd = random.normal(0, 0.002, DOF)
        m_y = random.uniform(-2, 2)
        torque = unlimited(ComputedTorqueController(model, gains=gains), q, qd, m_y)
        nonlinear = model.nonlinear_effects(q, qd).copy()
        acceleration = np.linalg.solve(model.mass_matrix(q), torque - nonlinear)
        tau_pd = gains.kp * (Q_REFERENCE - q - qd * DT) - gains.kd * (qd + acceleration * DT)
        expected = tau_pd + model.jacobian(q).T @ [0, 0, 0, 0, m_y, 0] + nonlinear
        np.testing.assert_allclose(torque, expected, atol=1e-9)


def test_holds_still_at_the_reference(model):
    torque = ComputedTorqueController(model).torque(
        Q_REFERENCE, np.zeros(DOF), model.gravity(Q_REFERENCE).copy(), np.zeros(1))
    np.testing.assert_allclose(torque, model.gravity(Q_REFERENCE), atol=1e-12)


def test_gravity_is_left_to_a_robot_that_compensates_it(model):
    qd = np.full(DOF, 0.001)
    whole = ComputedTorqueController(model)
    without = ComputedTorqueController(model, robot_compensates_gravity=True)
    difference = unlimited(whole, Q_REFERENCE, qd, 1.0) - unlimited(without, Q_REFERENCE, qd, 1.0)
    np.testing.assert_allclose(difference, model.gravity(Q_REFERENCE), atol=1e-9)


def test_torque_and_its_rate_are_limited():
    previous = np.zeros(DOF)
    np.testing.assert_array_equal(limit_torque(FAR, previous, 1.0), np.ones(DOF))
    np.testing.assert_array_equal(limit_torque(-FAR, TORQUE_MAX - 0.5, 1.0), TORQUE_MAX - 1.5)
    np.testing.assert_array_equal(limit_torque(FAR, TORQUE_MAX - 0.5, 1.0), TORQUE_MAX)


@pytest.mark.parametrize('gains', GAINS)
def test_all_gains_are_stable_on_the_simulated_arm(model, world, gains):
    """An explicit PD shakes the arm to its torque limits with each of these."""
    controller = ComputedTorqueController(model, gains=GAINS[gains])
    world.reset(HOME)
    for tick in range(1500):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, FIVE if tick < 300 else 0.0 * FIVE))
    q, qd = world.joint_state()
    assert np.abs(qd).max() < 0.05
    assert np.abs(q - Q_REFERENCE).max() < 0.1


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
