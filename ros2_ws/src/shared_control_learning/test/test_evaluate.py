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

"""The randomised test, and the table of episodes."""

import numpy as np
import pytest
from shared_control.env import SharedControlEnv
from shared_control.tasks.balance import BALANCE
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import EpisodeTable, read_rows
from shared_control_learning.evaluation.evaluate import Evaluation, as_tested, evaluate, passes
from shared_control_sim.local_plant import LocalPlant


def outcome(error=0.0, velocity=0.0, fallen=False):
    """10 s in which the ball is far off and fast, until the last 3 s."""
    early = np.full(350, 0.2)
    return Episode(BALANCE, phase='test', position_error=np.r_[early, np.full(150, error)].tolist(),
                   velocity=np.r_[early, np.full(150, velocity)].tolist(), failed=fallen)


def test_success_is_a_ball_kept_and_at_rest_in_the_centre_for_the_last_3_s():
    assert outcome(error=-0.019, velocity=-0.029).success
    assert not outcome(error=0.021).success
    assert not outcome(velocity=0.031).success
    assert not outcome(fallen=True).success


def test_19_of_20_pass():
    assert Evaluation((outcome(),) * 19 + (outcome(fallen=True),)).passed
    assert not Evaluation((outcome(),) * 18 + (outcome(fallen=True),) * 2).passed


def test_a_good_policy_succeeds_on_the_real_plant(good_robot):
    env = SharedControlEnv(LocalPlant(), as_tested(BALANCE))
    evaluation = evaluate(good_robot, env, episodes=2)
    assert evaluation.successes == 2
    assert evaluation.mean_position_error < 0.01
    assert len(evaluation.episodes[0].velocity) == 500
    starts = [e.position_error[0] for e in evaluation.episodes]
    assert starts == [e.position_error[0] for e in evaluate(good_robot, env, episodes=2).episodes]
    assert starts[0] != starts[1]
    env.close()


class Count(Callbacks):
    def __init__(self):
        self.started = self.tested = self.interruptions = 0

    def episode_started(self, episode):
        self.started += 1

    def episode_tested(self, episode):
        self.tested += 1

    def interrupted(self, error):
        self.interruptions += 1


def test_an_interrupted_test_episode_is_begun_anew(fake_plant):
    hooks, plant = Count(), fake_plant(interrupted_at=10)
    evaluate(lambda _: np.zeros(1), SharedControlEnv(plant, as_tested(BALANCE)), 2, callbacks=hooks)
    assert (hooks.started, hooks.tested, hooks.interruptions) == (3, 2, 1)


def test_decides_as_soon_as_the_answer_is_known(fake_plant):
    class Counting(fake_plant):
        resets = 0

        def reset(self, seed):
            self.resets += 1
            return super().reset(seed)

    plant = Counting()
    assert not passes(lambda _: np.zeros(1), SharedControlEnv(plant, as_tested(BALANCE)))
    assert plant.resets < 5


@pytest.fixture
def taught(fake_plant):
    env, episode = SharedControlEnv(fake_plant()), Episode(BALANCE)
    seen, _ = env.reset(seed=0)
    action = np.zeros(1, np.float32)
    for _ in range(3):
        _, reward, _, _, info = env.step(action)
        episode.add(seen, action, reward, info)
    return episode


def test_table_drops_what_the_learner_does_not_know_of(tmp_path, taught):
    path = tmp_path / 'episodes.csv'
    table = EpisodeTable(path)
    for taught.number in (1, 2, 3):
        table.append(taught)
    taught.phase, taught.number = 'test', 1
    table.append(taught)
    with path.open('a') as file:
        file.write('4,teach,7')
    table = EpisodeTable(path, taught=2)
    taught.phase, taught.number = 'teach', 3
    table.append(taught)
    rows = read_rows(path)
    assert [(r['episode'], r['phase'], r['steps']) for r in rows] == [(str(n), 'teach', '3') for n in (1, 2, 3)]
    assert float(rows[2]['return']) == pytest.approx(taught.episode_return, rel=1e-5)
