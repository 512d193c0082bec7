"""What it would save to step several worlds side by side: one vectorised sum for all, in place of each world's own.

    python benchmarks/side_by_side.py

CPU time of a tick of a world, with the worlds one after the other as tests of a policy run them, and in turn; both go
through the same states, to the bit. Nothing in the trainer steps worlds in turn: this says what that would be worth.
"""

import statistics
import time

import numpy as np
import pinocchio as pin
from headless import LEVEL, PHYSICS
from shared_control.command_line import script_parser
from shared_control_sim.local_plant import LocalPlant

WORLDS = (2, 5, 20)
ROUNDS = 9
TICKS = 700
SETTLING = 300
"""Ticks in which the ball comes to lie on the tray."""


def one_after_the_other(plants: list[LocalPlant]) -> None:
    """``TICKS`` of each plant."""
    for plant in plants:
        for _ in range(TICKS):
            plant.tick(LEVEL)


def side_by_side(plants: list[LocalPlant]) -> None:
    """The same ticks, in turn: pinocchio and the physics world by world, the sums of the controller for all at once."""
    controller = plants[0].controller
    model, data = controller._implicit, controller._implicit_data
    (row, _), = controller._jacobian_rows
    q, qd, torque = (np.empty((len(plants), controller._spec.dof)) for _ in range(3))
    effort = np.array([plant.world.effort for plant in plants])
    for _ in range(TICKS):
        for index, plant in enumerate(plants):
            q[index], qd[index] = plant.world.joint_state()
        wanted = controller._kp * (controller._q_reference - q)
        wanted -= controller._damping * qd
        for index in range(len(plants)):
            pin.crba(model, data, q[index], pin.Convention.WORLD)
            pin.cholesky.decompose(model, data)
            wanted[index] += row * LEVEL
            torque[index] = controller._model.inverse_dynamics(
                q[index], qd[index], pin.cholesky.solve(model, data, wanted[index]))
        limited = np.minimum(np.maximum(torque, effort - controller._rate), effort + controller._rate)
        effort = controller._spec.clamp_torque(limited)
        for plant, own in zip(plants, effort, strict=True):
            plant.world.step(own)


def measure(physics: str, count: int) -> list[float]:
    """What a tick takes side by side, in what it takes one after the other: one figure a round.

    Raises:
        RuntimeError: the two did not go through the same states.
    """
    plants = [LocalPlant(physics=physics) for _ in range(count)]
    ratios = []
    for seed in range(ROUNDS):
        seconds, ends = [], []
        for run in (one_after_the_other, side_by_side):
            for plant in plants:
                plant.reset(seed)
                for _ in range(SETTLING):
                    plant.tick(LEVEL)
            started = time.process_time()
            run(plants)
            seconds.append(time.process_time() - started)
            ends.append([plant.world.joint_state() for plant in plants])
        if not np.array_equal(*ends):
            raise RuntimeError('side by side the worlds go through other states')
        ratios.append(seconds[1] / seconds[0])
    for plant in plants:
        plant.close()
    return ratios


def main() -> None:
    """Entry point."""
    script_parser(__doc__).parse_args()
    for physics in PHYSICS:
        for count in WORLDS:
            ratios = measure(physics, count)
            print(f'{physics}, {count} worlds: {statistics.median(ratios):.2f} of one after the other '
                  f'[{min(ratios):.2f}, {max(ratios):.2f}]', flush=True)


if __name__ == '__main__':
    main()
