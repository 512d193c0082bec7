"""The benchmark of the tasks: the regulator that everything is compared with."""

import numpy as np
import pytest


@pytest.fixture(scope='module')
def tasks(load_benchmark):
    return load_benchmark('tasks')


def test_the_fitted_regulator_remembers_its_last_action_within_an_episode_alone(tasks):
    fitted = tasks.FittedRegulator(np.array([[0.5, 0.25]]), np.zeros(2), np.array([0.1]))
    seen = np.array([0.4])
    for _ in range(2):
        fitted.episode_started(None)
        assert [fitted.act(seen).item() for _ in range(2)] == pytest.approx([-0.1, -0.075])


def test_the_test_tells_it_when_an_episode_begins(tasks, monkeypatch):
    told = []

    def evaluate(act, env, seed, callbacks):
        told.append(callbacks)
        raise KeyboardInterrupt

    monkeypatch.setattr('learning.evaluate', evaluate)
    with pytest.raises(KeyboardInterrupt):
        tasks.fitted_regulator(tasks.load(tasks.TASKS, 'plate')(), 0, None)
    assert isinstance(told[0], tasks.FittedRegulator)
