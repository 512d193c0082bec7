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

"""The Gymnasium environment in this process."""

import copy
import pickle

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from shared_control.control.sharing import Sharing
from shared_control.env import SharedControlEnv
from shared_control.tasks.balance import THESIS
from shared_control_sim.local_plant import LocalPlant
from stable_baselines3.common.env_checker import check_env as check_env_for_sb3


@pytest.fixture
def env(physics):
    env = SharedControlEnv(LocalPlant(physics=physics))
    yield env
    env.close()


def rollout(env, seed, actions):
    observation, _ = env.reset(seed=seed)
    rows = [observation]
    for action in actions:
        observation, reward, terminated, truncated, _ = env.step(np.array([action], np.float32))
        rows.append([*observation[:2], reward])
        if terminated or truncated:
            break
    return np.array(rows)


@pytest.mark.filterwarnings('ignore:.*render modes.*')
def test_gymnasium_and_sb3_accept_it(env):
    check_env(env)
    check_env_for_sb3(env)


def test_what_is_closed_touches_no_other_and_is_used_no_more():
    closed = SharedControlEnv(LocalPlant(physics='bullet'))
    closed.reset(seed=1)
    closed.close()
    env = SharedControlEnv(LocalPlant(physics='bullet'))
    env.reset(seed=1)
    closed.close()
    with pytest.raises(Exception, match='physics server'):
        closed.reset(seed=1)
    with pytest.raises(Exception, match='physics server'):
        closed.step(np.zeros(1))
    with pytest.raises(Exception, match='physics server'):
        closed.plant.world.ball_state()
    env.step(np.zeros(1))
    env.close()


def test_a_copy_is_refused(env):
    for whole in (env, env.plant, env.plant.world, env.plant.controller):
        for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
            if whole is env.plant and attempt is copy.copy:
                continue  # which shares all that it has, as it does of any object
            with pytest.raises(TypeError, match='cannot be copied or pickled: make another'):
                attempt(whole)


@pytest.mark.parametrize('action', [0.5, [0.5, 0.5], [[0.5]], []])
def test_an_action_of_another_shape_is_refused(env, action):
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r'expected \(1,\)'):
        env.step(action)


def test_same_seed_same_episode(env):
    actions = np.sin(np.arange(100) / 10)
    np.testing.assert_array_equal(rollout(env, 5, actions), rollout(env, 5, actions))
    assert (rollout(env, 5, actions) != rollout(env, 6, actions)).any()


def test_episode_ends_after_its_time(env):
    env.reset(seed=0)
    for step in range(750):
        _, _, terminated, truncated, info = env.step(np.array([-0.26]))
        assert not terminated
        assert truncated == (step == 749)
    assert info['agent'][0] == pytest.approx(-0.26 * 8.0)


def test_a_fall_terminates_and_costs(physics):
    env = SharedControlEnv(LocalPlant(THESIS, physics=physics), THESIS)
    env.reset(seed=0)
    for _ in range(750):
        _, reward, terminated, truncated, info = env.step(np.array([1.0]))
        if terminated:
            break
    assert terminated and not truncated and info['failed'] and reward == -5000.0
    env.close()


class SteadyHand:
    """Presses left for good."""

    def reset(self, seed):
        pass

    def moment(self, state):
        return np.array([15.0])


def test_moments_are_told_apart_and_their_sum_is_limited():
    env = SharedControlEnv(LocalPlant(person=SteadyHand()))
    env.reset(seed=0)
    info = env.step(np.array([1.0]))[-1]
    assert (info['agent'][0], info['human'][0], info['applied'][0]) == (8.0, 15.0, 20.0)
    env.close()


def test_override_leaves_the_robot_out_while_a_person_holds_a_moment():
    class Holder:
        def reset(self, seed):
            self.steps = 0

        def moment(self, state):
            self.steps += 1
            return np.array([5.0 if self.steps % 2 else 0.0])

    env = SharedControlEnv(LocalPlant(person=Holder(), sharing=Sharing('override')))
    env.reset(seed=1)
    infos = [env.step(np.ones(1))[-1] for _ in range(4)]
    env.close()
    assert [(info['human'][0], info['agent'][0], info['applied'][0]) for info in infos] == [
        (5.0, 0.0, 5.0), (0.0, 8.0, 8.0)] * 2
