"""Observation, reward and termination."""

import math
from dataclasses import replace

import numpy as np
import pytest
from shared_control.tasks.balance.settings import THESIS_TASK
from shared_control.tasks.balance.task import BalanceState, BalanceTask, BallStarts

STATE = BalanceState(position_error=0.1, ball_velocity=-0.15, pitch=0.05, ball_height=0.93, manipulability=0.07)


def test_default_observation_keeps_sign_and_scale():
    np.testing.assert_allclose(BalanceTask().observation(STATE), [1.0, -1.0, 1.0], rtol=1e-6)


def test_thesis_observation_is_squeezed_by_its_own_extremes():
    observation = BalanceTask(THESIS_TASK).observation(STATE)
    np.testing.assert_allclose(observation, [1.0, 0.0, 0.8], rtol=1e-6)
    still = replace(STATE, position_error=0.0, ball_velocity=0.0, pitch=0.0)
    np.testing.assert_array_equal(BalanceTask(THESIS_TASK).observation(still), [0, 0, 0])


def test_reward_terms_by_hand():
    """Equations (31)-(37) with the weights of the appendix."""
    terms = BalanceTask().reward_terms(STATE)
    error = 0.1 ** 2 / 0.0642
    assert terms == pytest.approx({
        'R_alpha': -0.05 ** 2, 'R_V': -0.333 * 0.15 ** 2, 'R_kw': 0.5 * 0.07 ** 2, 'R_P': -10 * error,
        'R_Pe': math.exp(-20 * error)})
    thesis = BalanceTask(THESIS_TASK).reward_terms(STATE)
    assert thesis['R_kw'] == pytest.approx(0.5 * (1 - 0.07 ** 2))


def test_margin_counts_beyond_the_largest_error():
    terms = BalanceTask().reward_terms(replace(STATE, position_error=0.3, ball_velocity=0.0))
    assert terms['R_V'] == pytest.approx(-0.333 * 5)


def test_a_fallen_ball_ends_it():
    task = BalanceTask()
    fallen = replace(STATE, ball_height=0.8359)
    assert task.has_fallen(fallen) and not task.has_fallen(STATE)
    assert task.reward_terms(fallen) == {'fall': -5000.0}


def test_starts_follow_their_seed():
    one, two = BallStarts(3), BallStarts(4)
    first = [one.next() for _ in range(200)]
    assert first != [two.next() for _ in range(200)]
    two.seed(3)
    assert first == [two.next() for _ in range(200)]
    assert -0.6 <= min(first) < -0.59 and -0.31 < max(first) <= -0.3
