"""What a tick costs in this process (reading, controller, physics) beside the physics alone.

``stepSimulation`` is timed by itself within the very ticks that are timed as a whole: the states are the same, and
the machine is as busy.
"""

import statistics
import time
from typing import Any

import numpy as np
from shared_control_sim.bullet import BulletWorld
from shared_control_sim.local_plant import LocalPlant

ROUNDS = 7
TICKS = 4000
LEVEL = np.array([-2.1])
"""The moment that keeps the tray level, N m: the ball stays on it, in contact."""


class TimedWorld(BulletWorld):
    """A world that keeps how long its last physics step took, s."""

    def _advance(self) -> None:
        started = time.perf_counter()
        super()._advance()
        self.step_seconds = time.perf_counter() - started


def _round(plant: LocalPlant, world: TimedWorld) -> tuple[float, float]:
    """Medians of a tick and of the physics step in it, us."""
    plant.reset(seed=0)
    ticks, steps = [], []
    for _ in range(TICKS):
        started = time.perf_counter()
        plant.tick(LEVEL)
        ticks.append(time.perf_counter() - started)
        steps.append(world.step_seconds)
    return statistics.median(ticks) * 1e6, statistics.median(steps) * 1e6


def measure() -> dict[str, Any]:
    """``tick_us``, ``bullet_step_us`` and their ``ratio``: medians over the rounds."""
    plant = LocalPlant()
    plant.world.close()
    plant.world = world = TimedWorld()
    rounds = [_round(plant, world) for _ in range(ROUNDS)]
    plant.close()
    ratios = [tick / step for tick, step in rounds]
    return {'tick_us': round(statistics.median(tick for tick, _ in rounds), 2),
            'bullet_step_us': round(statistics.median(step for _, step in rounds), 2),
            'ratio': round(statistics.median(ratios), 3),
            'ratio_min_max': [round(min(ratios), 3), round(max(ratios), 3)]}
