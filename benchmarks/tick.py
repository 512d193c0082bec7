"""Where a tick of the live loop goes: the stations of simulator and controller, by the clock that both share.

    python benchmarks/tick.py                    # what `bench.py --only tick` runs

Both nodes run as :mod:`graph` runs them, with stamps taken at each station. The parts of a tick follow each other
without a gap, so their means add up to the tick's. ``period`` is from tick to tick.

``in_process_us`` is controller and physics of a tick in one process, without any middleware: one after the other, and
after the process has slept for a while. What it takes longer then is what it takes on the graph, too, where every tick
begins with waking up.
"""

import json
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from shared_control.command_line import script_parser

SECONDS = 6.0
SETTLING = 1000
"""Ticks at the start that are left out."""
SLEEPS = (0.0, 1e-4, 1e-3)
"""Before a tick in process, s."""
TICKS = 3000
"""In process, after each."""
SIMULATOR = ('begins', 'published', 'woken', 'taken', 'read', 'steps', 'stepped')
CONTROLLER = ('woken', 'taken', 'read', 'computes', 'computed', 'answered')
PARTS = ('simulator publishes the state', 'message travels, controller wakes', 'controller takes it',
         'controller reads it', 'controller takes and sums the moments', 'controller computes the torque',
         'controller publishes the torque', 'message travels, simulator wakes', 'simulator takes it',
         'simulator reads it', 'simulator, between reading and physics', 'physics')


class Stamps:
    """Times of a node's stations, one row a tick."""

    def __init__(self, stations: tuple[str, ...]):
        self._last = stations[-1]
        self._columns = {name: number for number, name in enumerate(stations, 1)}
        self._row = np.zeros(1 + len(stations), np.int64)
        self.rows: list[np.ndarray] = []

    def before(self, station: str, call: Callable[..., Any]) -> Callable[..., Any]:
        """``call``, with the time before it."""
        def stamped(*args: Any) -> Any:
            self._row[self._columns[station]] = time.perf_counter_ns()
            return call(*args)

        return stamped

    def after(self, station: str, call: Callable[..., Any]) -> Callable[..., Any]:
        """``call``, with the time after it; the last station ends the row."""
        column, is_last = self._columns[station], station == self._last

        def stamped(*args: Any) -> Any:
            result = call(*args)
            self._row[column] = time.perf_counter_ns()
            if is_last:
                self.rows.append(self._row.copy())
            return result

        return stamped

    def of_tick(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """``call``, whose first argument is the stamp that tells which tick it is."""
        def stamped(*args: Any) -> Any:
            self._row[0] = args[0]
            return call(*args)

        return stamped


def simulator(stamps: Stamps) -> Any:
    """The simulator's node with its stations stamped."""
    from panda_sim_node.node import PandaSimNode
    node = PandaSimNode()
    states, commands, world = node._states, node._commands, node._world
    states.publish = stamps.after('published', stamps.before('begins', stamps.of_tick(states.publish)))
    commands.wait_ready = stamps.after('woken', commands.wait_ready)
    commands.take = stamps.after('taken', commands.take)
    commands.read = stamps.after('read', commands.read)
    world.step = stamps.after('stepped', stamps.before('steps', world.step))
    return node


def controller(stamps: Stamps) -> Any:
    """The controller's node with its stations stamped."""
    from torque_ctrl_node.node import TorqueCtrlNode
    node = TorqueCtrlNode()
    states, reader = node._joint_states, node._reader
    states.wait_ready = stamps.after('woken', states.wait_ready)
    states.take = stamps.after('taken', states.take)
    reader.read = stamps.after('read', reader.read)
    node._controller.torque = stamps.after('computed', stamps.before('computes', node._controller.torque))
    node._command.answer = stamps.of_tick(node._command.answer)
    node._command_publisher.publish = stamps.after('answered', node._command_publisher.publish)
    return node


NODES = {'panda_sim_node': (simulator, SIMULATOR), 'torque_ctrl_node': (controller, CONTROLLER)}


def run_node(name: str, file: str, arguments: list[str]) -> int:
    """Run one of the nodes until it is told to stop, and write its rows to ``file``."""
    from shared_control_ros.runner import run
    make, stations = NODES[name]
    stamps = Stamps(stations)

    def stamped() -> Any:
        node = make(stamps)
        close = node.close

        def save_and_close() -> None:
            np.save(file, np.array(stamps.rows))  # here, since the middleware may never come back from taking leave
            close()

        node.close = save_and_close
        return node

    return run(stamped, [name, *arguments])


def measure() -> dict[str, Any]:
    """``tick_us`` and ``period_us``, and of each part its mean, median, 99th percentile (us) and share of the tick."""
    import graph  # not in the nodes, whose environment leads to no other scripts
    with tempfile.TemporaryDirectory() as folder:
        files = {name: str(Path(folder) / f'{name}.npy') for name in NODES}
        with graph.loop({name: [__file__, '--node', name, file] for name, file in files.items()}) as (domain, _):
            graph.last_report(domain, SECONDS)
        ticks, answers = (np.load(files[name])[SETTLING:] for name in NODES)
    return {**_figures(*_matched(ticks, answers)), 'in_process_us': in_process()}


def in_process() -> dict[str, float]:
    """Medians of controller and physics of a tick, us, by what the process did before."""
    from headless import LEVEL
    from shared_control_sim.local_plant import LocalPlant
    plant = LocalPlant()
    found = {}
    for sleep in SLEEPS:
        plant.reset(seed=0)
        times = []
        for _ in range(TICKS):
            if sleep:
                time.sleep(sleep)
            started = time.perf_counter()
            plant.tick(LEVEL)
            times.append(time.perf_counter() - started)
        name = f'after {1e3 * sleep:g} ms of sleep' if sleep else 'one after the other'
        found[name] = round(statistics.median(times) * 1e6, 1)
    plant.close()
    return found


def _matched(ticks: np.ndarray, answers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the same ticks."""
    answers = dict(zip(answers[:, 0], answers, strict=True))
    ticks = np.array([row for row in ticks if row[0] in answers])
    return ticks, np.array([answers[stamp] for stamp in ticks[:, 0]])


def _figures(ticks: np.ndarray, answers: np.ndarray) -> dict[str, Any]:
    # On one core the reader may run before the writer's call returns: the time until then is the writer's.
    published = np.minimum(ticks[:, 2], answers[:, 1])
    answered = np.minimum(answers[:, 6], ticks[:, 3])
    stations = np.stack([ticks[:, 1], published, *answers[:, 1:6].T, answered, *ticks[:, 3:8].T])
    parts = np.diff(stations, axis=0) * 1e-3
    whole = parts.sum(axis=0)
    period = np.diff(ticks[:, 1]) * 1e-3
    return {
        'tick_us': _summary(whole), 'period_us': _summary(period), 'ticks': len(whole),
        'parts_us': {name: {**_summary(part), 'share': round(float(part.mean() / whole.mean()), 3)}
                     for name, part in zip(PARTS, parts, strict=True)}}


def _summary(values: np.ndarray) -> dict[str, float]:
    p50, p99 = np.percentile(values, [50, 99])
    return {'mean': round(float(values.mean()), 1), 'p50': round(float(p50), 1), 'p99': round(float(p99), 1)}


def main() -> int:
    """Entry point."""
    if sys.argv[1:2] == ['--node']:
        return run_node(sys.argv[2], sys.argv[3], sys.argv[4:])
    script_parser(__doc__).parse_args()
    figures = measure()
    print(json.dumps(figures, indent=2))
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
