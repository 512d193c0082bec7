"""The pinocchio model: against numbers of the reference posture, finite differences and PyBullet."""

import numpy as np
import pybullet
import pytest
from panda_tray_description import URDF_PATH
from shared_control.robot.limits import DOF, JOINT_NAMES, Q_MAX, Q_MIN, QD_MAX, TORQUE_MAX
from shared_control.robot.model import PandaModel, manipulability, pitch
from shared_control.robot.posture import Q_REFERENCE
from shared_control_sim.bullet import BulletWorld


@pytest.fixture(scope='module')
def model():
    return PandaModel()


@pytest.fixture(scope='module')
def world():
    world = BulletWorld()
    yield world
    world.close()


def random_states(count):
    random = np.random.default_rng(1)
    for _ in range(count):
        yield random.uniform(Q_MIN, Q_MAX), random.uniform(-QD_MAX, QD_MAX)


def test_limits_are_those_of_table_1(model):
    np.testing.assert_array_equal(model.pin_model.upperPositionLimit, Q_MAX)
    np.testing.assert_array_equal(model.pin_model.lowerPositionLimit, Q_MIN)
    np.testing.assert_array_equal(model.pin_model.velocityLimit, QD_MAX)
    np.testing.assert_array_equal(model.pin_model.effortLimit, TORQUE_MAX)


def test_home_tray_is_where_the_appendix_drops_the_ball(model):
    position, rotation = model.tray_pose(Q_REFERENCE)
    np.testing.assert_allclose(position, [-0.485, 0.0, 0.908], atol=5e-4)
    assert np.rad2deg(pitch(rotation)) == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(rotation[:, 1], [0, 1, 0], atol=1e-9)  # long side along base x


def test_jacobian_is_the_derivative_of_the_pose(model):
    h = 1e-6
    for q, _ in random_states(5):
        jacobian = model.jacobian(q).copy()
        for joint in range(DOF):
            step = np.zeros(DOF)
            step[joint] = h
            p1, r1 = (a.copy() for a in model.tray_pose(q + step))
            p0, r0 = (a.copy() for a in model.tray_pose(q - step))
            spin = (r1 - r0) / (2 * h) @ ((r1 + r0) / 2).T
            np.testing.assert_allclose(jacobian[:3, joint], (p1 - p0) / (2 * h), atol=1e-7)
            np.testing.assert_allclose(jacobian[3:, joint], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-7)


def test_pybullet_agrees_on_mass_matrix_gravity_and_coriolis(model, world):
    still = [0.0] * DOF
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


def test_manipulability_at_home(model):
    k_w = manipulability(model.jacobian(Q_REFERENCE))
    assert k_w == pytest.approx(0.074, abs=5e-4)
    assert 1 - k_w ** 2 == pytest.approx(0.995, abs=5e-4)


def test_a_missing_description_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r'nowhere\.urdf'):
        PandaModel(tmp_path / 'nowhere.urdf')


def test_another_robots_description_is_refused(tmp_path):
    other = tmp_path / 'other.urdf'
    other.write_text(URDF_PATH.read_text().replace('panda_joint3', 'elbow'))
    with pytest.raises(ValueError, match='elbow'):
        PandaModel(other)


def test_joint_names_are_in_order(model):
    assert tuple(model.pin_model.names)[1:] == JOINT_NAMES
