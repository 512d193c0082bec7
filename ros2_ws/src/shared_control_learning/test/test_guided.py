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

"""The learner that makes a model of what all moments did."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from shared_control.env import SharedControlEnv
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import Plate
from shared_control.tasks.task import INTEGRAL_BOUND, Observer
from shared_control.teaching.tutors import tutor_named
from shared_control_learning.dynamics import Transitions, fit_dynamics
from shared_control_learning.evaluation.evaluate import as_tested, evaluate
from shared_control_learning.policy_file import load_policy, save_policy
from shared_control_learning.presets import GUIDED
from shared_control_learning.training import train
from shared_control_learning.warm_up import warm_up
from shared_control_sim.local_plant import LocalPlant
from shared_control_testing.rolling import GAIN, WALL, rolling

QUICK = replace(GUIDED, settings=replace(GUIDED.settings, model=replace(
    GUIDED.settings.model, iterations=4, batch=8, steps=20)))


@pytest.mark.parametrize('task', [BALANCE, Plate()], ids=lambda task: task.name)
def test_the_model_is_that_of_the_free_ball_although_walls_hold_it_a_good_part_of_the_time(task):
    random = np.random.default_rng(1)
    known = Transitions(task, 20)
    episode = rolling(task, lambda _: random.normal(size=len(task.axes)) * 0.6, seed=1)
    at_the_wall = np.mean([abs(error) >= WALL for error in episode.position_error])
    assert at_the_wall > 0.2
    known.add(episode, 1)
    model = fit_dynamics(known, periods=1)
    n, axes = known.size, len(task.axes)
    along = slice(2 * axes, 3 * axes)
    velocities = model.ab[:, axes:2 * axes]
    # v' = v + GAIN (tilt + 0.15 (0.8 u + 0.1 - tilt))
    assert torch.allclose(velocities[along], torch.eye(axes) * GAIN * 0.85, atol=4e-3)
    assert torch.allclose(velocities[-axes:], torch.eye(axes) * GAIN * 0.12, atol=2e-3)
    assert known.states.shape == (600, 2 * n + axes)


@pytest.mark.parametrize('human', [
    None, lambda number, error: -10.0 * np.sign(error[0]), lambda number, error: 10.0 * (number // 40 % 2)],
    ids=['nobody', 'an adversary', 'a sham'])
def test_whoever_gives_moments_two_episodes_teach_it_to_balance_alone(human):
    learner = GUIDED.make(3)
    for number in range(2):
        learner.begin()
        learner.learn_from(rolling(learner.task, learner.explore, seed=number, human=human))
    alone = rolling(learner.task, learner.act, seed=9)
    assert np.abs(alone.position_error[-150:]).max() < 0.15


def test_its_integral_does_away_with_a_push_that_it_never_met():
    learner = GUIDED.make(3)
    for number in range(3):
        learner.begin()
        learner.learn_from(rolling(learner.task, learner.explore, seed=number))
    pushed = rolling(learner.task, lambda seen: learner.act(seen) + 0.3, seed=9)
    assert np.abs(pushed.position_error[-100:]).mean() < 0.2


def test_a_ball_that_an_adversary_keeps_at_the_wall_does_not_turn_the_model_round():
    random = np.random.default_rng(1)
    known = Transitions(BALANCE, 20)
    episode = rolling(BALANCE, lambda _: random.normal(size=1) * 0.3, seed=2,
                      human=lambda number, error: -14.0 * np.sign(error[0]))
    assert np.mean([abs(error) >= WALL for error in episode.position_error]) > 0.8
    known.add(episode, 1)
    model = fit_dynamics(known, periods=1)
    assert float(model.ab[2, 1]) == pytest.approx(GAIN * 0.85, rel=0.2)
    assert known.moving[np.array(episode.position_error) >= WALL].mean() < 0.1


def test_it_goes_on_as_if_it_had_never_stopped(tmp_path):
    def teach(learner, number):
        learner.begin()
        learner.learn_from(rolling(learner.task, learner.explore, seed=number, steps=200, human=lambda n, e: 5.0))

    through, stopped = QUICK.make(1), QUICK.make(1)
    for learner in (through, stopped):
        teach(learner, 0)
    save_policy(stopped, tmp_path / 'policy.safetensors')
    stopped = load_policy(tmp_path / 'policy.safetensors')
    for learner in (through, stopped):
        teach(learner, 1)
    for name, tensor in through.tensors().items():
        assert torch.equal(tensor, stopped.tensors()[name]), name


@pytest.mark.parametrize(('edit', 'said'), [
    (lambda t: t.update({'transitions.moments': torch.zeros(3, 2)}), r'^transitions\.moments is'),
    (lambda t: t.pop('transitions.moments'), r'differ: transitions\.moments'),
    (lambda t: t.update({name: torch.zeros(100_001, *tensor.shape[1:])
                         for name, tensor in t.items() if name.startswith('transitions.')}), 'have 100001 rows'),
])
def test_transitions_that_are_not_its_own_are_refused(edit, said):
    learner = QUICK.make(1)
    tensors = learner.tensors()
    edit(tensors)
    with pytest.raises(ValueError, match=said):
        learner.restore(tensors)


def test_old_episodes_are_forgotten():
    known = Transitions(BALANCE, 2)
    for number in range(1, 5):
        known.add(rolling(BALANCE, lambda _: np.zeros(1), seed=number, steps=50), number)
    assert sorted(set(known.episodes[:, 0])) == [3.0, 4.0]


def test_the_integral_is_observed_bounded_and_begins_anew():
    task = replace(BALANCE, integrates=True)
    observer = Observer(task)
    state = SimpleNamespace(position_error=0.1, velocity=0.0, pitch=0.0)
    assert observer.observe(state, 0.0).tolist() == [1.0, 0.0, 0.0, 0.0]
    assert observer.observe(state, 0.5).tolist() == [1.0, 0.0, 0.0, 0.5]
    assert observer.observe(state, 100.0)[-1] == INTEGRAL_BOUND
    observer.reset()
    assert observer.observe(state, 0.0)[-1] == 0.0
    with pytest.raises(ValueError, match='detour has no position errors to integrate'):
        Observer(Detour(integrates=True))


def test_balances_in_the_simulator_after_two_episodes_with_an_adversary(tmp_path):
    train(GUIDED, tutor_named('contrary', 0), seed=0, episodes=2, evaluate_every=0, folder=tmp_path)
    env = SharedControlEnv(LocalPlant(GUIDED.task), as_tested(GUIDED.task))
    tested = evaluate(load_policy(tmp_path / 'policy.safetensors').act, env, episodes=4)
    env.close()
    assert tested.successes == 4


def test_an_episode_in_which_nothing_happened_changes_nothing_for_the_worse():
    warm_up(GUIDED)
    learner = QUICK.make(1)
    learner.begin()
    episode = rolling(learner.task, lambda _: np.zeros(1), seed=1, steps=130)
    for values in (episode.observations, episode.applied):
        values[:] = [np.zeros_like(value) for value in values]
    episode.last_observation = np.zeros(4, np.float32)
    episode.rewards[:] = [0.0] * 130
    learner.learn_from(episode)
    assert all(bool(torch.isfinite(tensor).all()) for tensor in learner.tensors().values())
