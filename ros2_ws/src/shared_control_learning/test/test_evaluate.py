"""The randomised test, and the table of episodes."""

import numpy as np
import pytest
from shared_control.env import BalanceEnv
from shared_control.tasks.balance.settings import DEFAULT_TASK
from shared_control_learning.callbacks import Hooks
from shared_control_learning.episode_table import EpisodeTable, read_rows
from shared_control_learning.evaluation.evaluate import Evaluation, TestEpisode, evaluate, passes, test_settings
from shared_control_learning.record import EpisodeRecord
from shared_control_sim.local_plant import LocalPlant


def outcome(error=0.0, velocity=0.0, fallen=False):
    """10 s in which the ball is far off and fast, until the last 3 s."""
    early = np.full(350, 0.2)
    return TestEpisode(
        np.r_[early, np.full(150, error)], np.r_[early, np.full(150, velocity)], fallen)


def test_success_is_a_ball_kept_and_at_rest_in_the_centre_for_the_last_3_s():
    assert outcome(error=-0.019, velocity=-0.029).success
    assert not outcome(error=0.021).success
    assert not outcome(velocity=0.031).success
    assert not outcome(fallen=True).success


def test_19_of_20_pass():
    assert Evaluation((outcome(),) * 19 + (outcome(fallen=True),)).passed
    assert not Evaluation((outcome(),) * 18 + (outcome(fallen=True),) * 2).passed


def test_a_good_policy_succeeds_on_the_real_plant(good_robot):
    env = BalanceEnv(LocalPlant(), test_settings(DEFAULT_TASK))
    evaluation = evaluate(good_robot, env, episodes=2)
    assert evaluation.successes == 2
    assert evaluation.mean_position_error < 0.01
    assert len(evaluation.episodes[0].velocity) == 500
    starts = [e.position_error[0] for e in evaluation.episodes]
    assert starts == [e.position_error[0] for e in evaluate(good_robot, env, episodes=2).episodes]
    assert starts[0] != starts[1]
    env.close()


class Count(Hooks):
    def __init__(self):
        self.started = self.tested = self.interruptions = 0

    def episode_started(self, record):
        self.started += 1

    def episode_tested(self, record):
        self.tested += 1

    def interrupted(self, error):
        self.interruptions += 1


def test_an_interrupted_test_episode_is_begun_anew(fake_plant):
    hooks, plant = Count(), fake_plant(interrupted_at=10)
    evaluate(lambda _: np.zeros(1), BalanceEnv(plant, test_settings(DEFAULT_TASK)), 2, hooks=hooks)
    assert (hooks.started, hooks.tested, hooks.interruptions) == (3, 2, 1)


def test_decides_as_soon_as_the_answer_is_known(fake_plant):
    class Counting(fake_plant):
        resets = 0

        def reset(self, seed):
            self.resets += 1
            return super().reset(seed)

    plant = Counting()
    assert not passes(lambda _: np.zeros(1), BalanceEnv(plant, test_settings(DEFAULT_TASK)))
    assert plant.resets < 5


@pytest.fixture
def record(fake_plant):
    env, record = BalanceEnv(fake_plant()), EpisodeRecord(1, 'teach')
    env.reset(seed=0)
    for _ in range(3):
        record.add(env.step(np.zeros(1, np.float32))[4])
    return record


def test_table_drops_what_the_learner_does_not_know_of(tmp_path, record):
    path = tmp_path / 'episodes.csv'
    table = EpisodeTable(path)
    for episode in (1, 2, 3):
        record.episode = episode
        table.append(record)
    record.phase, record.episode = 'test', 1
    table.append(record)
    with path.open('a') as file:
        file.write('4,teach,7')
    table = EpisodeTable(path, taught=2)
    record.phase, record.episode = 'teach', 3
    table.append(record)
    rows = read_rows(path)
    assert [(r['episode'], r['phase'], r['steps']) for r in rows] == [(str(n), 'teach', '3') for n in (1, 2, 3)]
    assert float(rows[2]['return']) == pytest.approx(record.episode_return, rel=1e-5)
