"""How time and memory grow with the length of a session, readers of the joints, participants, sessions exported.

    python benchmarks/growth.py                     # what `make bench-growth` runs
    python benchmarks/growth.py --only participants
    python benchmarks/growth.py --quick             # one small size, once: whether it runs

Each figure is from a process of its own: seconds of CPU (not of the clock, which others on the machine lengthen) after
all that it needs is loaded, and how far the peak of its memory rose from then on; medians over the rounds, with least
and most. With readers of the joints it is the simulator's CPU a tick. The exponent of growth is the slope of the
logarithms over the three largest sizes: 1 is linear. Writes OUTPUT/growth.json and a figure for each subject; the exit
code is 1 when something grows worse than linear.
"""

import json
import math
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache, partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from shared_control.command_line import script_parser
from shared_control.files import write_atomically
from shared_control_testing.usage import cpu_seconds, memory_bytes

ROUNDS = 3
LINEAR = 1.2
"""Exponents up to this are called linear: what such few sizes and rounds leave open."""
LITTLE_MB = 5.0
"""Memory that never grows by more has no exponent: most of it is the allocator's."""
SESSION_MINUTES = 5
"""Length of each session that is exported."""
READING_SECONDS = 8.0
READER = """
import time
import rclpy
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
rclpy.init()
joints = Polled(rclpy.create_node('reader'), contract.JOINT_STATES, depth=1000, raw=True)
while True:
    joints.clear()
    time.sleep(0.1)
"""
PARTICIPANTS = """
participants: {{simulated: {{expert: {third}, high: {third}, low: {third}}}}}
conditions: {{coached: {{episodes: 20}}, autonomous: {{episodes: 40, taught: false}}}}
"""

Cost = dict[str, float]
"""What one process took: ``cpu``, and ``mb``, by which its peak rose; what else is worth knowing."""
Work = Callable[[], Any]
"""What is measured, with all that it needs loaded."""


def report_session(folder: Path, _: Path) -> Work:
    """Report and picture of a session's folder."""
    from shared_control_records.session.folder import SessionFolder
    from shared_control_records.session.report import write_report
    return lambda: write_report(SessionFolder.open(folder))


def check_session(folder: Path, _: Path) -> Work:
    """Its bag read and checked."""
    from shared_control_records.bag.checks import check_bag
    from shared_control_records.bag.files import find_bag
    from shared_control_records.bag.reader import read_bag
    return lambda: check_bag(read_bag(find_bag(folder)))


def report_study(folder: Path, output: Path) -> Work:
    """The report of a study's folder."""
    from shared_control_records.study.folder import StudyFolder
    from shared_control_records.study_report.report import write_study_report
    return lambda: write_study_report(StudyFolder(folder), output)


def export(kind: str, folder: Path, output: Path) -> Work:
    """All sessions in a folder as one data set."""
    from shared_control_records.bag.files import find_bag
    from shared_control_records.bag.reader import read_bag
    from shared_control_records.export.frames import episode_frames
    from shared_control_records.export.lerobot import write_lerobot
    from shared_control_records.export.parquet import write_parquet
    write = {'parquet': write_parquet, 'lerobot': write_lerobot}[kind]
    return lambda: write([frames for session in sorted(folder.iterdir())
                          for frames in episode_frames(read_bag(find_bag(session)))], output)


def cost(prepare: Callable[[Path, Path], Work], data: Path) -> Cost:
    """What it takes; for a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        work = prepare(data, Path(folder) / 'output')
        before_mb, before = _peak_mb(), time.process_time()
        work()
        return {'cpu': time.process_time() - before, 'mb': _peak_mb() - before_mb}


def in_a_process(prepare: Callable[[Path, Path], Work], data: Path) -> Cost:
    """The same there."""
    with ProcessPoolExecutor(1, mp_context=get_context('spawn')) as pool:
        return pool.submit(cost, prepare, data).result()


def _peak_mb(process: int | str = 'self') -> float:
    return memory_bytes(process, peak=True) / 1e6


def read_joints(readers: int, seconds: float) -> Cost:
    """The simulator's CPU a tick while so many read ``/joint_states``, the controller among them; the tick, too.

    The others read as a recorder does, each a process, which the kernel places.
    """
    import graph
    from shared_control.processes import leave_with_the_parent
    with ExitStack() as stack:
        domain, simulator = stack.enter_context(graph.loop())
        for _ in range(readers - 1):
            other = stack.enter_context(subprocess.Popen(
                [sys.executable, '-c', READER], preexec_fn=leave_with_the_parent))
            stack.callback(other.kill)
        first, before, before_mb = graph.last_report(domain, 0.0, readers), cpu_seconds(simulator), _peak_mb(simulator)
        last = graph.last_report(domain, float(first['running_seconds']) + seconds)
        ticks = int(last['ticks']) - int(first['ticks'])
        return {'cpu': 1e3 * (cpu_seconds(simulator) - before) / ticks, 'mb': _peak_mb(simulator) - before_mb,
                'tick_p50_ms': float(last['tick_p50_ms']), 'tick_p99_ms': float(last['tick_p99_ms'])}


@dataclass(frozen=True)
class Subject:
    """Something that grows."""

    what: str
    """As the axis of a figure has it."""
    sizes: tuple[int, ...]
    quick: int
    steps: dict[str, Callable[[int], Cost]]
    """What is measured, by name: its cost at a size."""
    unit: str = 's'


def subjects(work: Path, quick: bool) -> dict[str, Subject]:
    """All of them, with their data in the folder ``work``, where it is made when it is first asked for."""
    from shared_control_testing.long_sessions import write_long_session
    from shared_control_testing.studies import made_study
    minutes = 1 if quick else SESSION_MINUTES

    @cache
    def session(length: int) -> Path:
        return write_long_session(work / f'{length} minutes', length).path

    @cache
    def sessions(number: int) -> Path:
        folder = work / f'{number} sessions'
        for index in range(number):
            shutil.copytree(session(minutes), folder / f'session_{index}')
        return folder

    @cache
    def study(participants: int) -> Path:
        plan = work / f'{participants}.yaml'
        plan.write_text(PARTICIPANTS.format(third=participants // 3))
        return made_study(work / f'{participants} participants', plan).path

    def of(prepare: Callable[[Path, Path], Work], data: Callable[[int], Path]) -> Callable[[int], Cost]:
        return lambda size: in_a_process(prepare, data(size))

    reading = partial(read_joints, seconds=1.0 if quick else READING_SECONDS)
    return {
        'session': Subject('minutes of a session', (5, 11, 22, 45), 1, {
            'report': of(report_session, session), 'read and check': of(check_session, session)}),
        'readers': Subject('readers of /joint_states, the controller included', (1, 2, 3, 5, 9), 2,
                           {'tick of the simulator': reading}, 'ms a tick'),
        'participants': Subject('participants in a study of two conditions', (6, 12, 24, 48), 3, {
            'report': of(report_study, study)}),
        'sessions': Subject(f'sessions of {minutes} minutes in an export', (1, 2, 4, 8), 2, {
            kind: of(partial(export, kind), sessions) for kind in ('parquet', 'lerobot')})}


def exponent(sizes: Sequence[float], values: Sequence[float]) -> float | None:
    """The slope of the logarithms over the three largest sizes; None of one size, or where a value is not positive."""
    sizes, values = sizes[-3:], values[-3:]
    if len(sizes) < 2 or min(values) <= 0:
        return None
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])


def measured(subject: Subject, sizes: Sequence[int], rounds: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """The figures of each of its steps, by name."""
    for name, step in subject.steps.items():
        # A round has all sizes, so that a machine that grows slower in the meantime slows all of them.
        costs = [[step(size) for size in sizes] for _ in range(rounds)]
        found: dict[str, Any] = {'sizes': list(sizes), 'unit': subject.unit}
        for key in costs[0][0]:
            values = [[cost[key] for cost in column] for column in zip(*costs, strict=True)]
            medians = [statistics.median(column) for column in values]
            found[key] = {'median': [round(m, 4) for m in medians],
                          'min_max': [[round(min(column), 4), round(max(column), 4)] for column in values]}
            if key in ('cpu', 'mb'):
                slope = None if key == 'mb' and max(medians) < LITTLE_MB else exponent(sizes, medians)
                found[key]['exponent'] = None if slope is None else round(slope, 2)
        yield name, found


def table(subject: str, steps: dict[str, dict[str, Any]]) -> str:
    """The figures as text: a line for each step and quantity, a column a size."""
    lines = []
    for name, figures in steps.items():
        for key, unit in (('cpu', f'CPU {figures["unit"]}'), ('mb', 'MB more'),
                          *((key, key) for key in figures if key.startswith('tick'))):
            row = figures[key]
            cells = ' '.join(f'{f"{m:.3g} [{low:.3g}, {high:.3g}]":>22}' for m, (low, high) in zip(
                row['median'], row['min_max'], strict=True))
            slope = '' if row.get('exponent') is None else f'  exponent {row["exponent"]}'
            lines.append(f'{f"{name}, {unit}":34}{cells}{slope}')
    sizes = ' '.join(f'{size:22}' for size in next(iter(steps.values()))['sizes'])
    return '\n'.join([f'{subject:34}{sizes}', *lines])


def draw(stem: Path, subject: Subject, steps: dict[str, dict[str, Any]]) -> None:
    """CPU and memory by size, with a straight line through nothing and the last size to compare with."""
    import matplotlib
    from shared_control_records.plotting.plot import Sheet, origin
    from shared_control_records.plotting.style import FAINT, PAPER
    with matplotlib.rc_context(PAPER):
        sheet = Sheet(7.0, 2.6)
        for axes, key, label in zip(sheet.content.subplots(1, 2), ('cpu', 'mb'), (
                f'CPU ({subject.unit})', 'memory (MB more)'), strict=True):
            for name, figures in steps.items():
                sizes, middle = np.array(figures['sizes']), np.array(figures[key]['median'])
                low, high = np.transpose(figures[key]['min_max'])
                axes.errorbar(sizes, middle, (middle - low, high - middle), marker='o', capsize=2, label=name)
                axes.plot((0, sizes[-1]), (0, middle[-1]), '--', color=FAINT, linewidth=0.8)
            axes.set(xlabel=subject.what, ylabel=label, xticks=sizes, xlim=(0, None), ylim=(0, None))
        axes.legend()
        sheet.save(stem, origin(), f'Growth with {subject.what}: medians, least and most. Dashed: proportional.')


def main() -> int:
    """Entry point; the exit code: 1 when something grows worse than linear."""
    names = ('session', 'readers', 'participants', 'sessions')
    parser = script_parser(__doc__)
    parser.add_argument('--only', choices=names, help='one subject (default: all)')
    parser.add_argument('--quick', action='store_true', help='one small size, once')
    parser.add_argument('--output', type=Path, default=Path('out/growth'), metavar='FOLDER',
                        help='folder for figures and numbers')
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    results: dict[str, dict[str, Any]] = {}
    worse = []
    with tempfile.TemporaryDirectory() as work:
        for name, subject in subjects(Path(work), args.quick).items():
            if args.only not in (None, name):
                continue
            sizes = (subject.quick,) if args.quick else subject.sizes
            results[name] = steps = dict(measured(subject, sizes, 1 if args.quick else ROUNDS))
            draw(args.output / name, subject, steps)
            print(table(subject.what, steps), end='\n\n', flush=True)
            write_atomically(args.output / 'growth.json', (json.dumps(results, indent=2) + '\n').encode())
            worse += [f'{name}, {step}: {key} grows with exponent {figures[key]["exponent"]}'
                      for step, figures in steps.items() for key in ('cpu', 'mb')
                      if (figures[key]['exponent'] or -math.inf) > LINEAR]
    print(f'figures and numbers in {args.output}')
    if args.quick:
        return 0
    for line in worse:
        print(f'worse than linear: {line}')
    return int(bool(worse))


if __name__ == '__main__':
    sys.exit(main())
