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

"""What learners are compared with: controllers by hand and by model, and published methods."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from shared_control.env import SharedControlEnv
from shared_control.plugins import LEARNERS, names
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.detour import Detour
from shared_control.tasks.plate import Plate
from shared_control_learning.baselines.lqr import regulator, tilting
from shared_control_learning.baselines.presets import (
    BEHAVIOUR_CLONING,
    DCOACH,
    HG_DAGGER,
    IDENTIFIED_LQR,
    LQR,
    PD,
    PVP,
    SAC_INTERVENTIONS,
    BaselinePreset,
)
from shared_control_learning.evaluation.evaluate import as_tested, evaluate
from shared_control_learning.policy_file import load_policy, save_policy
from shared_control_learning.presets import preset
from shared_control_sim.local_plant import LocalPlant
from shared_control_testing.rolling import rolling

BASELINES = [name for name in names(LEARNERS) if isinstance(preset(name), BaselinePreset)]


def taught(learner, episodes, human=None, steps=600):
    """The learner after some episodes with a ball between walls."""
    for number in range(episodes):
        learner.begin()
        learner.learn_from(rolling(learner.task, learner.explore, seed=number, human=human, steps=steps))
    return learner


@pytest.mark.parametrize('made', [PD, LQR], ids=lambda made: made.name)
def test_a_controller_by_hand_or_by_model_balances_the_ball_in_the_simulator(made, tmp_path):
    save_policy(made.make(1), tmp_path / 'policy.safetensors')
    env = SharedControlEnv(LocalPlant(BALANCE), as_tested(BALANCE))
    tested = evaluate(load_policy(tmp_path / 'policy.safetensors').act, env, episodes=2)
    env.close()
    assert tested.successes == 2


def test_the_known_model_tilts_as_the_simulated_arm_does():
    compliance, seconds, level = tilting(BALANCE)
    plant = LocalPlant(BALANCE)
    states = []
    for moment in (level, level + 5.0):
        plant.reset(3)
        for _ in range(round(4 * seconds / 0.02)):
            state = plant.advance(np.array([moment]))
        states.append(BALANCE.describe(state, plant.controller._model).pitch)
    plant.close()
    assert states[1] - states[0] == pytest.approx(5.0 * compliance, rel=0.1)


def test_the_regulator_is_that_of_the_textbook():
    # x' = x + u with equal weights: the golden ratio solves the Riccati equation.
    gain = regulator(np.eye(1), np.eye(1), np.eye(1), np.eye(1))
    assert gain == pytest.approx((np.sqrt(5) - 1) / 2)


@pytest.mark.parametrize('task', [BALANCE, Plate()], ids=lambda task: task.name)
@pytest.mark.parametrize('human', [None, lambda number, error: -10.0 * np.sign(error[0])],
                         ids=['nobody', 'an adversary'])
def test_one_episode_identifies_what_a_regulator_needs(task, human):
    learner = taught(replace(IDENTIFIED_LQR, task=task).make(3), 1, human)
    alone = rolling(task, learner.act, seed=9)
    assert np.abs(alone.position_error[-150:]).max() < 0.2


def test_what_cannot_be_regulated_leaves_the_policy_as_it_is():
    learner = IDENTIFIED_LQR.make(1)
    episode = rolling(BALANCE, lambda _: np.zeros(1), seed=1, steps=100)
    for values in (episode.observations, episode.applied):
        values[:] = [np.zeros_like(value) for value in values]
    episode.last_observation = np.zeros(3, np.float32)
    assert learner.learn_from(episode) == {'model/stabilised': 0.0}
    assert not learner.weights.any() and learner.episode == 1


def spring(number, error):
    """A person who works against the error at once, with the moment that a spring would give."""
    return 4.0 * float(error[0])


def test_behaviour_cloning_gives_no_moment_itself_and_does_what_was_shown():
    learner = BEHAVIOUR_CLONING.make(1)
    assert not learner.explore(np.ones(3, np.float32)).any()
    taught(learner, 1, spring, steps=300)
    assert learner.weights[0] == pytest.approx([4.0 / BALANCE.scale[0], 0.0, 0.0], abs=0.03)
    assert learner.bias == pytest.approx([0.0], abs=0.02)


def test_hg_dagger_adds_what_the_person_did_when_they_took_over_and_nothing_else():
    learner = taught(HG_DAGGER.make(1), 1, spring, steps=300)
    shown = learner.weights.copy()
    taught(learner, 1, None, steps=300)
    assert len(learner._shown) == 300 and np.array_equal(learner.weights, shown)
    learner.learn_from(rolling(BALANCE, learner.explore, seed=4, steps=300,
                               human=lambda number, error: 2.0 if number < 50 else 0.0))
    assert len(learner._shown) == 350
    assert learner._shown['actions'][-50:, 0] == pytest.approx(
        learner._shown['observations'][-50:] @ shown[0] + 2.0 / BALANCE.scale[0], abs=0.05)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_dcoach_moves_the_policy_the_way_of_the_advice_by_its_sign_alone(sign):
    small, large = (DCOACH.make(1) for _ in range(2))
    before = [small.act(observation)[0] for observation in np.eye(3, dtype=np.float32)]
    for learner, size in ((small, 5.0), (large, 10.0)):
        learner.learn_from(rolling(
            BALANCE, lambda _: np.zeros(1), seed=1, steps=100, human=lambda number, error, m=size: sign * m))
    after = [small.act(observation)[0] for observation in np.eye(3, dtype=np.float32)]
    assert (sign * (np.array(after) - before) > 0.02).any()
    rows = small._corrections
    assert np.array_equal(rows['labels'], np.full((100, 1), sign * DCOACH.settings.error, np.float32))
    assert np.array_equal(rows['labels'], large._corrections['labels'])


def test_dcoach_without_advice_learns_nothing_and_with_much_forgets_the_oldest():
    learner = DCOACH.make(1)
    before = {name: tensor.clone() for name, tensor in learner.tensors().items()}
    taught(learner, 1, None, steps=100)
    assert all(torch.equal(tensor, before[name]) for name, tensor in learner.tensors().items())
    learner = replace(DCOACH, settings=replace(DCOACH.settings, memory=30)).make(1)
    taught(learner, 1, lambda number, error: 5.0, steps=100)
    assert len(learner._corrections) == 30


def test_half_of_every_minibatch_are_interventions_and_their_action_is_what_counted():
    learner = SAC_INTERVENTIONS.make(1)
    episode = rolling(BALANCE, lambda _: np.full(1, 0.25), seed=1, steps=200,
                      human=lambda number, error: 4.0 if number < 10 else 0.0)
    episode.failed = True
    learner.replay.add(episode)
    learner.replay.random = np.random.default_rng(1)
    batch = learner.replay.sample(100)
    intervened = learner.replay.rows('intervened')[:, 0] == 1.0
    assert 50 <= int(intervened.sum()) < 65
    assert torch.equal(batch.actions[:, 0], torch.where(intervened, 0.75, 0.25))
    assert learner.replay.memory['ended'].nonzero()[0].tolist() == [199]
    assert np.array_equal(learner.replay.memory['next'][:-1], learner.replay.memory['observations'][1:])


def test_sac_learns_what_is_rewarded():
    random = np.random.default_rng(1)
    quick = replace(SAC_INTERVENTIONS.settings, gamma=0.0, hidden=(16,), learning_rate=0.01, batch_size=64)
    learner = replace(SAC_INTERVENTIONS, settings=quick).make(1)
    episode = rolling(BALANCE, lambda _: random.uniform(-1.0, 1.0, 1), seed=1, steps=300)
    episode.rewards[:] = [-float(action[0] - 0.4) ** 2 for action in episode.actions]
    learner.learn_from(episode)
    assert np.mean([learner.act(observation) for observation in episode.observations]) == pytest.approx(0.4, abs=0.15)


def test_pvp_values_what_the_person_did_above_what_the_robot_wanted_and_follows_it():
    learner = replace(PVP, settings=replace(PVP.settings, hidden=(16,), batch_size=64)).make(1)
    before = {name: tensor.clone() for name, tensor in learner.tensors().items()}
    taught(learner, 1, None, steps=100)
    assert all(torch.equal(tensor, before[name]) for name, tensor in learner.tensors().items()
               if not name.startswith('memory'))
    episode = rolling(BALANCE, lambda _: np.full(1, -0.5), seed=1, steps=300, human=lambda number, error: 8.0)
    learner.learn_from(episode)
    seen = torch.as_tensor(np.array(episode.observations))
    with torch.no_grad():
        given, refused = (learner._algorithm.critic.q1_forward(seen, torch.full((300, 1), action))
                          for action in (0.5, -0.5))
    assert (given > refused).float().mean() > 0.9
    assert np.mean([learner.act(observation) for observation in episode.observations]) > 0.2


@pytest.mark.parametrize('name', ['pd', 'lqr', 'identified_lqr'])
def test_a_task_that_a_baseline_does_not_know_is_refused_by_name(name):
    with pytest.raises(ValueError, match=f'{name}.*detour'):
        replace(preset(name), task=Detour()).make()


@pytest.mark.parametrize('name', BASELINES)
def test_tensors_that_are_not_its_own_are_refused(name):
    learner = preset(name).make(1)
    tensors = learner.tensors()
    first = next(iter(tensors))
    with pytest.raises(ValueError, match=first):
        learner.restore({**tensors, first: tensors[first].new_zeros(7, 9, 2)})
    with pytest.raises(ValueError, match='another'):
        learner.restore({**tensors, 'another': tensors[first]})
