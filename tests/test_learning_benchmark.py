"""The learning benchmark: how conditions are compared, and when a run is done."""

import json
from pathlib import Path

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


@pytest.fixture
def taught(learning, monkeypatch):
    """How many episodes runs were asked for; a run is never skilled."""
    asked = []

    def teach(condition, seed, folder, episodes):
        asked.append(episodes)
        return {'seed': seed, 'skilled': None, 'episodes': episodes}

    monkeypatch.setattr(learning, 'taught', teach)
    return asked


def test_a_run_that_fewer_episodes_ended_goes_on_when_more_are_asked_for(learning, taught, tmp_path):
    for limit in (10, 10, 5, None, None, 10):
        result = learning.run('autonomous', 3, tmp_path, limit, retention=False)
    assert taught == [10, 40]
    assert result == json.loads((tmp_path / 'result.json').read_text()) == {'seed': 3, 'skilled': None, 'episodes': 40}


@pytest.mark.parametrize(('skilled', 'episodes'), [(6, 6), (None, 40)])
def test_a_run_that_is_skilled_or_had_all_its_episodes_is_done(skilled, episodes, learning, taught, tmp_path):
    result = {'seed': 3, 'skilled': skilled, 'episodes': episodes}
    (tmp_path / 'result.json').write_text(json.dumps(result))
    assert learning.run('autonomous', 3, tmp_path, None, retention=False) == result
    assert not taught


def test_a_kill_while_the_result_is_written_leaves_none_and_the_next_start_works(
        learning, taught, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(Path, 'replace', lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            learning.run('autonomous', 3, tmp_path, 10, retention=False)
    assert not list(tmp_path.iterdir())
    assert learning.run('autonomous', 3, tmp_path, 10, retention=False)['episodes'] == 10
