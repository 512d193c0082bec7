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

"""The thesis' validation: each of its checks agrees, and would notice if it did not."""

import json
from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from shared_control.command_line import write_json
from shared_control.control.references import cosine_reference, cosine_velocity
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control_records.plotting.plot import origin
from shared_control_records.validation.chain import end_pose, full_chain, table_2_chain
from shared_control_records.validation.compliance import check_compliance
from shared_control_records.validation.figures import plots
from shared_control_records.validation.model_checks import BOUND, check_model, home_figures
from shared_control_records.validation.newton_euler import newton_euler
from shared_control_records.validation.run import Validation
from shared_control_records.validation.tracking import Tracking, track
from shared_control_sim.bullet import BulletWorld


@pytest.fixture(scope='module')
def model():
    return RobotModel()


@pytest.fixture(scope='module')
def checks(model):
    return check_model(model)


def test_all_of_the_model_agrees(checks):
    assert len(checks) == 5
    for check in checks:
        assert check.passed, check


@pytest.fixture(scope='module')
def compliances(model):
    world = BulletWorld()
    yield check_compliance(model, world)
    world.close()


def test_each_moment_tilts_the_tray_about_its_own_axis_as_predicted(compliances):
    about_x, about_y = compliances
    assert about_x.passed and about_y.passed
    assert about_x.measured == pytest.approx((0.287, 0.0), abs=1e-3)
    assert about_y.measured == pytest.approx((0.0, 0.483), abs=1e-3)
    assert not replace(about_x, measured=(0.281, 0.0)).passed
    assert not replace(about_x, measured=(0.287, 0.004)).passed


def test_a_wrong_model_is_noticed():
    wrong = RobotModel()
    wrong.pin_model.jointPlacements[4].translation = np.array([0.0825 + 1e-6, 0.0, 0.0])
    wrong.pin_model.inertias[3].mass += 1e-3
    failed = [check.name for check in check_model(wrong) if not check.passed]
    assert any('full chain' in name for name in failed)
    assert any('Jacobian' in name for name in failed)


def test_home_is_where_the_design_has_it(model):
    home = home_figures(model)
    np.testing.assert_allclose(home.table_2_flange, [-0.318, 0, 0.056], atol=5e-4)
    np.testing.assert_allclose(home.flange, [-0.485, 0, 0.908], atol=5e-4)
    assert home.one_minus_manipulability_squared == pytest.approx(0.995, abs=5e-4)


def test_the_stretched_chains_are_as_long_as_their_links():
    assert end_pose(table_2_chain(np.zeros(panda().dof)))[2, 3] == pytest.approx(0.333 + 0.316 + 0.384 + 0.107)
    np.testing.assert_allclose(
        end_pose(full_chain(np.zeros(panda().dof)))[:3, 3], [0.088, 0, 0.333 + 0.316 + 0.384 - 0.107], atol=1e-12)


def test_newton_euler_carries_a_weight_at_the_tip(model):
    """A wrench on the last link costs -J^T W (15)."""
    still = np.zeros(panda().dof)
    alone = newton_euler(model.pin_model, panda().home, still, still, np.zeros(3), np.zeros(3))
    np.testing.assert_allclose(alone, model.gravity(panda().home), atol=1e-12)
    rotation = model.tray_pose(panda().home)[1] @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])  # of link 7
    weight = np.array([0.0, 0, -10])
    lever = np.array([0, 0, 0.107])
    in_link = rotation.T @ weight
    loaded = newton_euler(model.pin_model, panda().home, still, still, in_link, np.cross(lever, in_link))
    np.testing.assert_allclose(loaded - alone, -model.jacobian(panda().home)[:3].T @ weight, atol=1e-12)


def test_the_reference_moves_the_tray_and_turns_nothing(model):
    reference = cosine_reference(model, 0.5, 1.0, 0.001)
    home, rotation = (a.copy() for a in model.tray_pose(panda().home))
    for tick in (249, 499, 999):
        position, turned = model.tray_pose(reference.q[tick])
        x = 0.05 * np.sin(np.pi * (tick + 1) / 1000)
        np.testing.assert_allclose(position - home, [x, 0, 0], atol=2e-5)
        np.testing.assert_allclose(turned, rotation, atol=2e-5)
    assert cosine_velocity(0.0, 0.5) == pytest.approx(0.05 * np.pi)


def test_the_non_linear_terms_help_the_low_gains(model):
    world = BulletWorld()
    reference = cosine_reference(model, 1.0, 3.0, 0.001)
    with_terms, without = (track(model, world, 'low', terms, 1.0, reference) for terms in (True, False))
    world.close()
    assert with_terms.rms < without.rms
    assert with_terms.rms_settled < 0.5 * without.rms_settled
    assert with_terms.distance[-1] < 0.003 < without.distance[-1]


@pytest.fixture
def runs():
    """Runs of an arm that is a little slow, and slower without the terms."""
    seconds = np.arange(1, 4001) * 1e-3
    result = []
    for frequency in (0.25, 0.5, 1.0):
        reference = cosine_velocity(seconds, frequency)
        for gains in ('high', 'low'):
            for terms in (True, False):
                measured = reference * (0.99 if terms else 0.9)
                result.append(Tracking(gains, terms, frequency, seconds, reference, measured,
                                       np.full(4000, 1e-3), np.full(4000, 0.07)))
    return result


def test_table_and_json(tmp_path, runs, model, checks, compliances):
    validation = Validation(checks, home_figures(model), runs, compliances)
    assert validation.passed
    assert 'help at every frequency' in validation.table()
    assert 'ok   m_x: 0.286 0.000, predicted by J^T W: 0.287 0.000' in validation.table()
    write_json(validation.as_json(), tmp_path / 'new' / 'v.json')
    content = json.loads((tmp_path / 'new' / 'v.json').read_text())
    assert content['passed'] and len(content['tracking']) == 12
    assert max(check['difference'] for check in content['checks']) < BOUND


def test_figures_3_to_11_and_more(tmp_path, runs):
    found = list(plots(runs))
    assert [plot.name[:5] for plot in found[:9]] == [f'fig{number:02d}' for number in range(3, 12)]
    assert len(found) > 9
    for plot in (found[8], found[-1]):
        plot.save(tmp_path, origin(7, date(2026, 11, 26)))
        assert plot.caption.endswith('.') and (tmp_path / f'{plot.name}.pdf').read_bytes().startswith(b'%PDF')
        assert (tmp_path / f'{plot.name}.png').read_bytes().startswith(b'\x89PNG')
        assert '</svg>' in (tmp_path / f'{plot.name}.svg').read_text()


def test_terms_that_do_not_help_fail(runs, model):
    swapped = [run for run in runs if run.frequency != 0.5] + [
        Tracking(r.gains, not r.nonlinear_terms, r.frequency, r.seconds, r.reference, r.measured, r.distance,
                 r.manipulability) for r in runs if r.frequency == 0.5]
    validation = Validation([], home_figures(model), swapped, [])
    assert validation.worse_with_terms == [0.5] and not validation.passed
    assert 'FAIL' in validation.table()
