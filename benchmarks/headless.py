"""What a tick costs in this process (reading, controller, physics) beside the physics alone, with each physics.

The engine's step is timed by itself within the very ticks that are timed as a whole: the states are the same, and the
machine is as busy. Rounds with the one physics and with the other alternate. Where the rest of a tick goes is timed in
further rounds, and what a step of a policy costs beside its ticks in episodes of a policy. Ticks with two axes, on
`plate`, too.
"""

import statistics
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest import mock

import numpy as np
import pinocchio as pin
from shared_control.env import SharedControlEnv
from shared_control.plugins import TASKS, load
from shared_control.rates import TICKS_PER_ACTION
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.evaluation.evaluate import as_tested, run_test_episode
from shared_control_learning.presets import COACHED
from shared_control_sim.local_plant import LocalPlant

PHYSICS = ('bullet', 'mujoco')
ROUNDS = 7
TICKS = 4000
LEVEL = np.array([-2.1])
"""The moment that keeps the tray of `balance` level, N m: the ball stays on it, in contact."""
LEVELS = {'balance': LEVEL, 'plate': np.array([-0.1, -2.5])}
"""The same of each task that is measured."""


class TimedPlant(LocalPlant):
    """A plant that keeps how long its last physics step took, s."""

    def __init__(self, task: str, physics: str):
        super().__init__(load(TASKS, task)(), physics=physics)
        self._level = LEVELS[task]
        advance = self.world._advance

        def timed() -> None:
            started = time.perf_counter()
            advance()
            self.step_seconds = time.perf_counter() - started

        self.world._advance = timed

    def round(self) -> tuple[float, float]:
        """Medians of a tick and of the physics step in it, us."""
        self.reset(seed=0)
        ticks, steps = [], []
        for _ in range(TICKS):
            started = time.perf_counter()
            self.tick(self._level)
            ticks.append(time.perf_counter() - started)
            steps.append(self.step_seconds)
        return statistics.median(ticks) * 1e6, statistics.median(steps) * 1e6


def measure() -> dict[str, Any]:
    """``tick_us``, ``step_us``, their ``ratio``, ``parts_us`` and ``policy_step_us`` with PyBullet, the same below
    ``mujoco``, and how long MuJoCo's tick takes in PyBullet's: medians over the rounds; ticks with two axes below
    ``plate``."""
    figures, plate = (_ticks(task) for task in LEVELS)
    for physics, own in zip(PHYSICS, (figures, figures['mujoco']), strict=True):
        own |= {'parts_us': parts(physics), 'policy_step_us': policy_step(physics)}
    return {**figures, 'plate': plate}


def _ticks(task: str) -> dict[str, Any]:
    plants = [TimedPlant(task, physics) for physics in PHYSICS]
    rounds = [[plant.round() for plant in plants] for _ in range(ROUNDS)]
    for plant in plants:
        plant.close()
    bullet, mujoco = (_figures(list(own)) for own in zip(*rounds, strict=True))
    return {**bullet, 'mujoco': {
        **mujoco, **_spread('tick_in_bullets', [mujoco / bullet for (bullet, _), (mujoco, _) in rounds])}}


def parts(physics: str) -> dict[str, float]:
    """Where a tick goes: medians of its parts, us. ``rest``: the sums of the controller, and calls."""
    plant, seconds = LocalPlant(physics=physics), {}
    world = plant.world
    with ExitStack() as stack:
        for owner, name in ((world, 'joint_state'), (world, 'step'), (world, '_advance'), (pin, 'crba'),
                            (pin.cholesky, 'decompose'), (pin.cholesky, 'solve'), (pin, 'rnea'), (plant, 'tick')):
            seconds[name] = stack.enter_context(_timed(owner, name))
        plant.reset(seed=0)
        for _ in range(TICKS):
            plant.tick(LEVEL)
    world.close()
    took = {name: statistics.median(values) * 1e6 for name, values in seconds.items()}
    figures = {'read_joints': took['joint_state'], 'set_torques': took['step'] - took['_advance'],
               'pinocchio': took['crba'] + took['decompose'] + took['solve'] + took['rnea'],
               'physics': took['_advance']}
    figures['rest'] = took['tick'] - sum(figures.values())
    return {name: round(figure, 2) for name, figure in figures.items()}


@contextmanager
def _timed(owner: Any, name: str) -> Iterator[list[float]]:
    """How long each call of ``owner``'s function takes, s, while this lasts."""
    function, seconds = getattr(owner, name), []

    def timed(*args: Any) -> Any:
        started = time.perf_counter()
        result = function(*args)
        seconds.append(time.perf_counter() - started)
        return result

    with mock.patch.object(owner, name, timed):
        yield seconds


def policy_step(physics: str) -> float:
    """What a step of a linear policy of PPO costs beside its ticks, us: the policy, reading, reward, keeping, and that
    the next tick finds the caches cold; by medians of what goes by from each of the
    twenty ticks to the next, in an episode of a test."""
    learner = COACHED.make()
    learner.policy.action_net.bias.data.fill_(float(LEVEL[0] / learner.task.scale[0]))
    task = as_tested(learner.task)
    plant = LocalPlant(task, physics=physics)
    began: list[float] = []
    tick = plant.tick

    def timed(moment: np.ndarray) -> None:
        began.append(time.perf_counter())
        tick(moment)

    with mock.patch.object(plant, 'tick', timed):
        run_test_episode(learner.act, SharedControlEnv(plant, task), 1, 0, Callbacks())
    plant.close()
    spent = np.diff(began)[:1 - TICKS_PER_ACTION]
    by_place = np.median(spent.reshape(-1, TICKS_PER_ACTION), axis=0)
    return round(float(by_place.sum() - TICKS_PER_ACTION * np.median(spent)) * 1e6, 1)


def _figures(rounds: list[tuple[float, float]]) -> dict[str, Any]:
    ticks, steps = zip(*rounds, strict=True)
    return {'tick_us': round(statistics.median(ticks), 2), 'step_us': round(statistics.median(steps), 2),
            **_spread('ratio', [tick / step for tick, step in rounds])}


def _spread(name: str, values: list[float]) -> dict[str, Any]:
    middle, low, high = (round(value, 3) for value in (statistics.median(values), min(values), max(values)))
    return {name: middle, f'{name}_min_max': [low, high]}
