"""The learning benchmark: how conditions are compared."""

import pytest


@pytest.fixture(scope='module')
def learning(load_benchmark):
    return load_benchmark('learning')


def runs(*skilled):
    return [{'seed': seed, 'skilled': episodes} for seed, episodes in enumerate(skilled)]


def test_shares_are_compared_by_seed_at_the_same_number_of_episodes(learning):
    late = runs(*[12] * 10, *[9] * 10)
    difference, low, high = learning.share_skilled_against(runs(*[2] * 20), late, 10)
    assert difference == 0.5 and 0.2 < low < 0.5 < high < 0.8
    assert learning.share_skilled_against(runs(*[2] * 20), late, 12) == [0.0, 0.0, 0.0]
    never = runs(*[None] * 20)
    assert learning.share_skilled_against(never, late, 10)[0] == -0.5
    assert learning.share_skilled_against(never, never, 10) == [0.0, 0.0, 0.0]
