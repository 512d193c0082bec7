"""What a tick costs in this process: controller, physics and reading, beside bare physics of the same world."""

import statistics
import time
from typing import Any

import pybullet
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.robot.model import PandaModel
from shared_control.world.ball_on_tray import BallOnTrayWorld

ROUNDS = 7
TICKS = 4000


def _ticks(world: BallOnTrayWorld, controller: ComputedTorqueController) -> float:
    world.reset(-0.45)
    started = time.perf_counter()
    for _ in range(TICKS):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, -2.1))
    return (time.perf_counter() - started) / TICKS * 1e6


def _bare_steps(world: BallOnTrayWorld) -> float:
    world.reset(-0.45)
    started = time.perf_counter()
    for _ in range(TICKS):
        pybullet.stepSimulation(world.client)
    return (time.perf_counter() - started) / TICKS * 1e6


def measure() -> dict[str, Any]:
    """``tick_us``, ``bullet_step_us`` and their ``ratio``: medians over the rounds, in turn."""
    world, controller = BallOnTrayWorld(), ComputedTorqueController(PandaModel())
    pairs = [(_ticks(world, controller), _bare_steps(world)) for _ in range(ROUNDS)]
    world.close()
    ratios = [tick / step for tick, step in pairs]
    return {'tick_us': round(statistics.median(p[0] for p in pairs), 2),
            'bullet_step_us': round(statistics.median(p[1] for p in pairs), 2),
            'ratio': round(statistics.median(ratios), 3),
            'ratio_min_max': [round(min(ratios), 3), round(max(ratios), 3)]}
