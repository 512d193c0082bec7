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

"""Plants that are not as they were when a policy was taught."""

from math import radians, sin

import numpy as np
import pytest
from shared_control.robot.inertials import with_fer_inertials, with_masses_times
from shared_control.robot.model import GRAVITY, RobotModel
from shared_control.robot.spec_file import panda
from shared_control.scene import Ball
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.plate import Plate
from shared_control_sim.changed_plant import ChangedPlant, senses_of
from shared_control_sim.changes import AS_TAUGHT, CHANGES, Change, change_named
from shared_control_sim.local_plant import LocalPlant


def rest(plant, periods=50):
    """The states of an episode in which nobody does anything."""
    plant.reset(3)
    return [plant.advance(np.zeros_like(plant._none)) for _ in range(periods)]


@pytest.fixture
def plant_with(physics):
    made = []

    def make(change, task=BALANCE):
        made.append(ChangedPlant(task, change, physics=physics))
        return made[-1]

    yield make
    for plant in made:
        plant.close()


@pytest.mark.parametrize('task', [BALANCE, Plate()], ids=lambda task: task.name)
def test_without_a_change_it_is_the_plant_that_policies_are_taught_on(plant_with, physics, task):
    plain = LocalPlant(task, physics=physics)
    for one, other in zip(rest(plain), rest(plant_with(AS_TAUGHT, task)), strict=True):
        assert one.ball_position == other.ball_position and one.q.tolist() == other.q.tolist()
    plain.close()


@pytest.mark.parametrize('task', [BALANCE, Plate()], ids=lambda task: task.name)
def test_a_ball_rolls_down_a_tray_that_sits_askew_while_the_arm_thinks_it_level(plant_with, task):
    level, askew = (rest(plant_with(change, task), 40) for change in (AS_TAUGHT, Change('', askew=radians(2.0))))
    speed = [one.ball_velocity[0] - other.ball_velocity[0] for one, other in zip(askew, level, strict=True)]
    assert speed[39] - speed[19] == pytest.approx(0.4 * 5 / 7 * GRAVITY * sin(radians(2.0)), rel=0.1)
    np.testing.assert_allclose(askew[39].q, level[39].q, atol=0.01)


@pytest.mark.parametrize('task', [BALANCE, Plate()], ids=lambda task: task.name)
def test_a_larger_ball_is_dropped_as_any_other(plant_with, physics, task):
    for radius in (0.01, 0.03):
        plant = plant_with(Change('', ball=Ball(radius=radius)), task)
        start, state = plant.reset(3), None
        for _ in range(20):
            state = plant.advance(np.zeros_like(plant._none))
            assert state.ball_position[2] <= start.ball_position[2] + 1e-4, 'thrown up'
        assert start.ball_position[2] - state.ball_position[2] == pytest.approx(0.01, abs=0.001)


def test_wrong_masses_in_the_controller_let_the_arm_sag_or_rise(plant_with):
    heights = []
    for factor in (0.9, 1.0, 1.1):
        plant = plant_with(Change('', model_masses=factor))
        heights.append(RobotModel(plant.spec).tray_pose(rest(plant)[-1].q)[0][2])
    assert heights[0] < heights[1] - 1e-3 and heights[1] < heights[2] - 1e-3


def test_friction_holds_the_joints_against_a_small_moment(plant_with):
    speeds = []
    for friction in (0.0, 0.5):
        plant = plant_with(Change('', joint_friction=friction))
        plant.reset(3)
        for _ in range(50):
            plant.advance(np.array([0.4]))
        speeds.append(np.abs(plant.world.joint_state()[1]).max())
    assert speeds[1] < 0.3 * speeds[0]


def test_every_change_of_the_test_changes_what_happens_to_ball_or_eyes(plant_with):
    seen = {}
    changes = [change for change in CHANGES if not change.name.startswith('friction of') or change.ball is None]
    for change in changes:  # but that of the ball, which rolls without slipping on a tray as level as here
        states, senses = rest(plant_with(change), 10), senses_of(change)
        if senses is not None:
            senses.reset(3)
            states = [senses.perceive(state) for state in states]
        seen[change.name] = tuple(np.round([*states[-1].ball_position, *states[-1].ball_velocity, *states[-1].q], 12))
    assert len(set(seen.values())) == len(changes), seen


def test_senses_are_late_and_noisy_but_the_same_for_the_same_seed(plant_with):
    states = rest(plant_with(AS_TAUGHT), 30)
    late, noisy = senses_of(Change('', late=2)), senses_of(Change('', noise=True))
    late.reset(1)
    assert [late.perceive(state) for state in states[:4]] == [states[0], states[0], states[0], states[1]]
    tracks = []
    for _ in range(2):
        noisy.reset(1)
        tracks.append(np.array([noisy.perceive(state).ball_position for state in states]))
    np.testing.assert_array_equal(*tracks)
    errors = tracks[0] - [state.ball_position for state in states]
    assert errors.std() == pytest.approx(0.002, rel=0.3)


def test_other_inertias_change_masses_and_nothing_of_the_tool():
    spec = panda()
    own, heavy, fer = (RobotModel(spec, text).pin_model for text in (
        None, with_masses_times(spec, 1.1), with_fer_inertials(spec)))
    links, last = range(1, 7), 7
    for joint in links:
        assert heavy.inertias[joint].mass == pytest.approx(1.1 * own.inertias[joint].mass)
    assert own.inertias[last].mass - heavy.inertias[last].mass == pytest.approx(-0.0735522)
    assert [fer.inertias[joint].mass for joint in links] == pytest.approx(
        [2.7907, 2.542, 2.2513, 2.2037, 2.2855, 1.353])
    assert fer.inertias[last].mass == pytest.approx(0.35973 + 0.382704)
    # The gravity torque that the controller then misses: -3.7 N m at joint 2, 1.1 at joint 4.
    torques = [RobotModel(spec, text).gravity(spec.home).copy() for text in (None, with_fer_inertials(spec))]
    np.testing.assert_allclose((torques[1] - torques[0])[[1, 3]], [-3.7, 1.1], atol=0.06)


def test_a_change_is_found_by_its_name():
    assert change_named('tray askew by +1 deg').askew == pytest.approx(radians(1.0))
    with pytest.raises(ValueError, match=r"no change 'x'; there are: as taught, ball of 0\.05 kg"):
        change_named('x')
