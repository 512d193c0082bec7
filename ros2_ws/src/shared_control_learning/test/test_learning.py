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

"""Presets, the learners and the learn loop."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from shared_control.env import SharedControlEnv
from shared_control.plugins import LEARNERS, names
from shared_control.tasks.balance import BALANCE
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.corrections import find_corrections
from shared_control_learning.episode import Episode
from shared_control_learning.learn import learn
from shared_control_learning.presets import AUTONOMOUS, COACHED, COACHED_NETWORK, preset, preset_for
from shared_control_learning.settings import CoachingSettings
from shared_control_testing.rolling import rolling


def weights(learner):
    return torch.cat([p.detach().flatten() for p in learner.policy.parameters()])


def step(human):
    """What an environment tells of a step in which the human held ``human``, N m."""
    moment = np.array([human])
    return {'human': moment, 'agent': np.zeros(1), 'applied': moment, 'failed': False, 'reward_terms': {},
            'state': SimpleNamespace(position_error=0.0, velocity=0.0)}


def make_episode(learner, steps=130, human=None):
    """Made-up observations; the learner's own choices."""
    random = np.random.default_rng(0)
    episode = Episode(BALANCE)
    for number in range(steps):
        seen = random.normal(size=3).astype(np.float32)
        held = 0.0 if human is None else human[number]
        episode.add(seen, learner.explore(seen), float(random.normal()), step(held))
    episode.last_observation = np.zeros(3, np.float32)
    return episode


def mean_action(learner, episode):
    return np.mean([learner.act(observation) for observation in episode.observations])


def test_unknown_preset_is_refused_with_the_names_of_all():
    with pytest.raises(ValueError, match=r'autonomous, .*coached, coached_network, .*guided, .*thesis'):
        preset('magic')


def test_lambda_fades():
    coaching = CoachingSettings(weight=2.0, fade_episodes=4)
    assert [coaching.weight_in(episode) for episode in range(1, 7)] == [2.0, 1.5, 1.0, 0.5, 0.0, 0.0]


def test_corrections_belong_to_the_states_some_delays_before():
    coaching = CoachingSettings(gain=2.0, delays=(0.1, 0.2))
    episode = Episode(BALANCE)
    human = [0.0] * 40
    human[12], human[22], human[3], human[39] = 5.0, -1.0, 5.0, 5.0
    for number in range(40):
        episode.add(np.full(3, number, np.float32), np.zeros(1, np.float32), 0.0, step(human[number]))
    found = find_corrections(episode, 4, np.full((40, 1), 0.1, np.float32), coaching)
    # Step 12 comes 10 after step 2 and 5 after step 7. Of step 34 it is not known what the person made of it.
    assert found.observations[:, 0].tolist() == [2.0, 7.0, 12.0, 17.0, 29.0]
    assert found.labels[:, 0].tolist() == pytest.approx([0.55, 0.55, -0.025, -0.025, 0.55])
    assert found.weights[:, 0].tolist() == [0.5] * 5
    assert found.episodes[:, 0].tolist() == [4.0] * 5


def test_corrections_are_taught_for_some_episodes_and_then_forgotten():
    learner = COACHED.make()
    learner.begin()
    learner.learn_from(make_episode(learner, human=[5.0] * 130))
    remembered = len(learner.corrections)
    assert remembered > 50
    for later in (1, 2):
        learner.learn_from(make_episode(learner))
        assert len(learner.corrections) == remembered, f'{later} episodes later'
    learner.learn_from(make_episode(learner))
    assert len(learner.corrections) == 0


@pytest.mark.parametrize(('task', 'name', 'learned_by', 'observed'), [
    ('balance', '', 'guided', 4), ('balance', 'coached', 'coached', 3), ('plate', '', 'guided', 8),
    ('plate', 'coached', 'coached', 6), ('detour', '', 'coached_network', 6), ('detour', 'guided', 'guided', 6)])
def test_a_task_is_learned_by_its_own_preset_and_seen_as_the_preset_has_it(task, name, learned_by, observed):
    found = preset_for(task, name)
    assert (found.name, found.task.name, found.task.observed_size) == (learned_by, task, observed)
    assert found.make().act(np.zeros(observed, np.float32)).shape == (len(found.task.axes),)


def test_exploring_fades_and_its_noise_is_correlated():
    learner = AUTONOMOUS.make()
    spread, neighbours = [], []
    for learner.episode in (0, 30):
        noise = []
        for _ in range(40):
            learner.begin()
            seen = np.zeros(3, np.float32)
            noise.append([float((learner.explore(seen) - learner.act(seen))[0]) for _ in range(50)])
            learner.seed = len(noise)
        noise = np.array(noise)
        spread.append(noise.std())
        neighbours.append(np.corrcoef(noise[:, :-1].ravel(), noise[:, 1:].ravel())[0, 1])
    assert spread[0] > 3 * spread[1]
    assert min(neighbours) > 0.8


@pytest.mark.parametrize('name', ['coached', 'coached_network'])
def test_acts_as_the_network_of_stable_baselines_does_whatever_became_of_its_weights(name):
    learner = preset(name).make()
    untaught = {key: tensor.clone() for key, tensor in learner.tensors().items()}
    episode = make_episode(learner, human=[5.0] * 130)

    def acts():
        own = np.array([learner.act(seen) for seen in episode.observations])
        network, _ = learner.policy.predict(np.array(episode.observations), deterministic=True)
        np.testing.assert_allclose(own, network.clip(-1.0, 1.0), rtol=1e-5, atol=1e-6)
        return own

    first = acts()
    learner.learn_from(episode)
    assert np.abs(acts() - first).max() > 0.01
    learner.restore(untaught)
    np.testing.assert_array_equal(acts(), first)


def test_without_corrections_coached_ppo_is_ppo():
    coached, plain = COACHED.make(3), replace(COACHED, settings=replace(COACHED.settings, coaching=None)).make(3)
    for learner in (coached, plain):
        learner.begin()
        learner.learn_from(make_episode(learner))
    assert torch.equal(weights(coached), weights(plain))


def test_own_loss_is_that_of_stable_baselines(monkeypatch):
    """With corrections of weight nearly nothing, the coached epochs do what PPO's own do."""
    coached, plain = COACHED.make(3), replace(COACHED, settings=replace(COACHED.settings, coaching=None)).make(3)
    monkeypatch.setattr(CoachingSettings, 'weight_in', lambda *_: 1e-30)
    for learner in (coached, plain):
        learner.begin()
        learner.learn_from(make_episode(learner, human=[5.0] * 130))
    assert torch.allclose(weights(coached), weights(plain), atol=1e-6)


@pytest.mark.parametrize('human', [0.0, 5.0])
def test_the_learning_rate_falls_within_an_update(monkeypatch, human):
    learner = COACHED_NETWORK.make()
    optimizer, rates = learner.policy.optimizer, []
    step = optimizer.step
    monkeypatch.setattr(optimizer, 'step', lambda: (rates.append(optimizer.param_groups[0]['lr']), step()))
    for number in range(2):
        rates.clear()
        learner.learn_from(make_episode(learner, human=[human] * 130))
        settings = learner.settings.ppo
        assert rates[0] == settings.learning_rate_in(number + 1)
        assert rates[-1] == pytest.approx(rates[0] / settings.epochs)
        assert rates == sorted(rates, reverse=True)


def test_corrections_move_the_policy_to_their_side():
    for sign in (-1.0, 1.0):
        learner = COACHED.make()
        episode = make_episode(learner, human=[5.0 * sign] * 130)
        before = mean_action(learner, episode)
        learner.learn_from(episode)
        assert sign * (mean_action(learner, episode) - before) > 0.02


@pytest.mark.parametrize('name', names(LEARNERS))
def test_learns_episode_by_episode_and_repeats_itself(name, fake_plant):
    def run():
        learner = preset(name).make(1)
        learn(learner, SharedControlEnv(fake_plant(5.0, falls_at=133), learner.task), episodes=2)
        return learner

    first, second = run(), run()
    assert first.episode == 2
    again = second.tensors()
    assert all(torch.equal(tensor, again[name]) for name, tensor in first.tensors().items())
    assert all(torch.isfinite(tensor).all() for tensor in again.values())


class Watch(Callbacks):
    """Writes down what it is told."""

    def __init__(self, stop_after=None):
        self.told, self.stop_after, self.records = [], stop_after, []

    def should_stop(self):
        return len(self.records) == self.stop_after

    def episode_started(self, episode):
        self.told.append(f'started {episode.number}')

    def interrupted(self, error):
        self.told.append(f'interrupted: {error}')

    def learning_started(self, episode):
        self.told.append('learning')

    def episode_learned(self, episode, figures):
        self.told.append(f'learned {episode.number}')
        self.records.append(episode)


def test_an_interrupted_episode_is_begun_anew(fake_plant):
    learner, watch = AUTONOMOUS.make(), Watch()
    learn(learner, SharedControlEnv(fake_plant(interrupted_at=50, falls_at=70)), episodes=1, callbacks=watch)
    assert watch.told == ['started 1', 'interrupted: gone', 'started 1', 'learning', 'learned 1']
    assert len(watch.records[0]) == 70


def test_stops_when_told_and_fills_in_the_record(fake_plant):
    learner, watch = COACHED.make(), Watch(stop_after=1)
    learn(learner, SharedControlEnv(fake_plant(5.0, falls_at=100)), callbacks=watch)
    assert learner.episode == 1
    row = watch.records[0].row()
    assert (row['steps'], row['fallen'], row['phase']) == (100, 1, 'teach')
    assert row['return'] == pytest.approx(sum(row[t] for t in ('R_alpha', 'R_V', 'R_kw', 'R_P', 'R_Pe', 'fall')))
    assert row['fall'] == -5000.0
    assert row['intervention_rate'] == 1.0
    assert row['mean_abs_human'] == 5.0
    assert 0.3 < row['human_share'] < 1.0
    assert row['learn_seconds'] > 0.0


def test_a_learner_leaves_other_random_numbers_alone():
    np.random.seed(1)  # noqa: NPY002 - the global generators are what is looked at
    torch.manual_seed(1)
    expected = np.random.random(), torch.rand(1)  # noqa: NPY002
    np.random.seed(1)  # noqa: NPY002
    torch.manual_seed(1)
    learner = COACHED.make(5)
    learner.begin()
    learner.learn_from(make_episode(learner, human=[5.0] * 130))
    assert (np.random.random(), torch.rand(1)) == expected  # noqa: NPY002


def test_interventions_presses_and_the_share_of_noise_are_counted():
    episode = rolling(BALANCE, lambda _: np.full(1, 0.5), seed=1, steps=40,
                      human=lambda number, error: 5.0 if 10 <= number < 20 else 10.0 if number >= 30 else 0.0)
    assert (episode.interventions, episode.presses) == (2, 3)
    assert episode.held.sum() == 20
    policy, noise, human = 40 * 3.2 ** 2, 40 * 0.8 ** 2, 10 * 5.0 ** 2 + 10 * 10.0 ** 2
    assert episode.noise_share(lambda _: np.full(1, 0.4)) == pytest.approx(noise / (noise + policy + human))
    assert episode.noise_share(lambda _: np.full(1, 0.5)) == 0.0
    episode.agent[:] = [np.zeros(1)] * 40  # as in override, while the person holds a moment
    assert episode.noise_share(lambda _: np.zeros(1)) == 0.0
