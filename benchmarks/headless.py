"""What a tick costs in this process (reading, controller, physics) beside the physics alone, with each physics.

The engine's step is timed by itself within the very ticks that are timed as a whole: the states are the same, and the
machine is as busy. Rounds with the one physics and with the other alternate.
"""

import statistics
import time
from typing import Any

import numpy as np
from shared_control_sim.local_plant import LocalPlant

PHYSICS = ('bullet', 'mujoco')
ROUNDS = 7
TICKS = 4000
LEVEL = np.array([-2.1])
"""The moment that keeps the tray level, N m: the ball stays on it, in contact."""


class TimedPlant(LocalPlant):
    """A plant that keeps how long its last physics step took, s."""

    def __init__(self, physics: str):
        super().__init__(physics=physics)
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
            self.tick(LEVEL)
            ticks.append(time.perf_counter() - started)
            steps.append(self.step_seconds)
        return statistics.median(ticks) * 1e6, statistics.median(steps) * 1e6


def measure() -> dict[str, Any]:
    """``tick_us``, ``step_us`` and their ``ratio`` with PyBullet, the same below ``mujoco``, and how long MuJoCo's tick
    takes in PyBullet's: medians over the rounds."""
    plants = [TimedPlant(physics) for physics in PHYSICS]
    rounds = [[plant.round() for plant in plants] for _ in range(ROUNDS)]
    for plant in plants:
        plant.close()
    bullet, mujoco = (_figures(list(own)) for own in zip(*rounds, strict=True))
    return {**bullet, 'mujoco': {
        **mujoco, **_spread('tick_in_bullets', [mujoco / bullet for (bullet, _), (mujoco, _) in rounds])}}


def _figures(rounds: list[tuple[float, float]]) -> dict[str, Any]:
    ticks, steps = zip(*rounds, strict=True)
    return {'tick_us': round(statistics.median(ticks), 2), 'step_us': round(statistics.median(steps), 2),
            **_spread('ratio', [tick / step for tick, step in rounds])}


def _spread(name: str, values: list[float]) -> dict[str, Any]:
    middle, low, high = (round(value, 3) for value in (statistics.median(values), min(values), max(values)))
    return {name: middle, f'{name}_min_max': [low, high]}
