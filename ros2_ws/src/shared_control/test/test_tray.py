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

"""The tray of a task on the robot: its inertia, and where it is."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying, mass_properties
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import PLATE_SCENE, plate_scene

ACRYLIC = 1190.0


def test_the_boxes_of_the_thesis_have_the_inertia_that_its_urdf_has():
    """Written down in the URDF by hand, long before it was computed here."""
    mass, centre, inertia = mass_properties(replace(BALANCE.scene, density=ACRYLIC))
    assert mass == pytest.approx(0.382704, abs=1e-6)
    np.testing.assert_allclose(centre, [0, 0, 0.0042687], atol=1e-7)
    np.testing.assert_allclose(np.diag(inertia), [0.000473933, 0.005687085, 0.006151538], atol=1e-8)


def test_an_unsymmetric_body_by_pinocchio():
    scene = Detour.scene
    total = pin.Inertia.Zero()
    for box in scene.boxes:
        volume = float(np.prod(box.size))
        total += pin.SE3(np.eye(3), np.array(box.centre)).act(pin.Inertia.FromBox(ACRYLIC * volume, *box.size))
    mass, centre, inertia = mass_properties(scene)
    assert mass == pytest.approx(total.mass)
    np.testing.assert_allclose(centre, total.lever, atol=1e-12)
    np.testing.assert_allclose(inertia, total.inertia, atol=1e-12)


def test_the_robot_carries_the_plate_where_it_had_its_tray():
    bare, loaded = RobotModel(), RobotModel(carrying(panda(), PLATE_SCENE))
    for one, other in zip(bare.tray_pose(panda().home), loaded.tray_pose(panda().home), strict=True):
        np.testing.assert_array_equal(one, other)
    heavier = mass_properties(PLATE_SCENE)[0] - 0.382704
    weight = np.array([0.0, 0.0, -9.81 * heavier])
    more = loaded.gravity(panda().home) - bare.gravity(panda().home)
    np.testing.assert_allclose(more, -bare.jacobian(panda().home)[:3].T @ weight, atol=0.01)


def test_the_task_of_the_thesis_leaves_the_tray_to_the_robot():
    assert carrying(panda(), BALANCE.scene) is panda()
    with pytest.raises(ValueError, match='no density'):
        mass_properties(BALANCE.scene)


def test_a_plate_of_another_size_and_nothing_carried_twice():
    once = carrying(panda(), plate_scene(side=0.2))
    assert carrying(once, plate_scene(side=0.2)) is once
    assert '0.21 0.21 0.006' in once.description and '0.21 0.21 0.006' not in carrying(once, PLATE_SCENE).description
    assert once.description.count('<link name="panda_tray"') == 1
