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

"""The tests of a policy: what is done to the plant, and what is kept of it."""

import numpy as np
import pytest
from shared_control.control.references import FREQUENCIES, cosine_velocity
from shared_control.env import SharedControlEnv
from shared_control.tasks.balance import BALANCE
from shared_control_learning.evaluation.evaluate import as_tested, evaluate
from shared_control_learning.evaluation.perturbation import FORCE, PUSHES, run_perturbation
from shared_control_learning.evaluation.randomized import run_randomized
from shared_control_learning.evaluation.result import TRACKS, TRANSFER
from shared_control_learning.evaluation.run import count_episodes
from shared_control_learning.evaluation.trajectory import run_trajectory
from shared_control_learning.evaluation.transfer import run_transfer
from shared_control_sim.changes import AS_TAUGHT, CHANGES, change_named
from shared_control_sim.local_plant import LocalPlant


def check_shapes(result, episodes, seconds):
    steps = round(seconds * 50)
    assert result.seconds[0] == pytest.approx(0.02) and result.seconds[-1] == pytest.approx(seconds)
    for name in TRACKS:
        assert getattr(result, name).shape == (episodes, steps), name
    assert result.fallen.shape == (episodes,)


def test_randomized_is_the_evaluation_with_more_written_down(good_robot):
    result = run_randomized(good_robot, episodes=2)
    check_shapes(result, 2, 10)
    env = SharedControlEnv(LocalPlant(), as_tested(BALANCE))
    for row, theirs in enumerate(evaluate(good_robot, env, 2).episodes):
        np.testing.assert_array_equal(result.position_error[row], theirs.position_error)
        np.testing.assert_array_equal(result.velocity[row], theirs.velocity)
        assert result.success[row] and theirs.success
    env.close()
    assert (result.manipulability > 0.07).all() and (result.manipulability < 0.076).all()
    np.testing.assert_allclose(
        np.diff(result.position_error) / 0.02, result.velocity_error[:, 1:], atol=0.12)


def test_perturbation_pushes_twice_and_a_good_policy_recovers(good_robot):
    result = run_perturbation(good_robot)
    check_shapes(result, 1, 30)
    error = np.abs(result.position_error[0])
    before, between = (result.seconds > 3) & (result.seconds <= 5), (result.seconds > 9) & (result.seconds <= 10)
    for start, end in PUSHES:
        assert error[(result.seconds > start) & (result.seconds <= end + 1)].max() > 3 * error[before].max()
    assert error[between].mean() < 0.05
    assert not result.fallen[0]
    assert error[-150:].mean() < 0.02


def test_a_push_up_and_forwards_is_more_than_the_agent_can_hold(good_robot):
    """Why docs/reference/protocols.md pushes forwards and down: 8 N m against a push of equal signs lose the ball."""
    step = 0

    def full_counter_moment(observation):
        nonlocal step
        step += 1
        return np.array([-1.0]) if 5 < step * 0.02 <= 6 else good_robot(observation)

    force = (FORCE[0], 0.0, -FORCE[2])
    result = run_perturbation(full_counter_moment, force=force)
    assert result.fallen[0]
    fall = np.isfinite(result.position_error[0]).sum()
    assert 6 < result.seconds[fall - 1] < 7
    assert np.isnan(result.manipulability[0, fall:]).all()


def test_trajectory_moves_the_tray_as_a_cosine(good_robot):
    frequency = FREQUENCIES[-1]
    result = run_trajectory(good_robot, frequency)
    check_shapes(result, 1, 20)
    tray = (result.velocity_error + result.velocity)[0]
    late = result.seconds > 2
    reference = cosine_velocity(result.seconds, frequency)
    assert np.std((tray - reference)[late]) < 0.1 * np.std(reference[late])
    assert not result.fallen[0]


def test_the_test_on_other_arms_has_a_row_for_each_change(good_robot):
    changes = [AS_TAUGHT, change_named('tray askew by +2 deg'), change_named('seen with noise')]
    results = run_transfer(good_robot, episodes=2, changes=changes)
    assert [result.test for result in results] == [TRANSFER + change.name for change in changes]
    plain = run_randomized(good_robot, episodes=2)
    np.testing.assert_array_equal(results[0].position_error, plain.position_error)
    errors = [np.abs(result.position_error[:, -150:]).mean() for result in results]
    assert errors[1] > errors[0] + 0.02  # a law without an integral has nothing against a tray that sits askew
    assert results[2].success.all() and errors[2] != errors[0]
    assert count_episodes('transfer', 2) == 2 * len(CHANGES)
