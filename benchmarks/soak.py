"""A long session with a simulated tutor: what each node takes, and whether memory, descriptors, threads or ticks grow.

    python benchmarks/soak.py --minutes 60        # what `make soak MINUTES=60` runs

Prints a line a minute for each process of the session and for the simulator's ticks, then what has grown. Growth is a
slope over the minutes after the first fifth that is three times its standard error and more than what is allowed: a
slope is a failure (exit code 1).
"""

import json
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from shared_control.command_line import script_parser
from shared_control_ros import contract
from shared_control_ros.reports import values_of
from shared_control_testing.faults.plan import NODES
from shared_control_testing.live_session import Session
from shared_control_testing.nodes import Observer, free_domain
from shared_control_testing.usage import cpu_seconds, memory_bytes
from tqdm import tqdm

ALLOWED = {'memory_mb': 0.2, 'descriptors': 0.02, 'threads': 0.02, 'shared_memory_mb': 0.05, 'tick_p50_ms': 0.002}
"""Growth a minute. The learner keeps every correction, some 20 kB an episode."""
PARAMETERS = 'session_recorder_node: {ros__parameters: {split_minutes: 2.0}}'
"""The index of a file of the bag stays in memory until the file ends, 0.3 MB a minute. By default a file ends after a
quarter of an hour: so that it does not look like growth, it ends sooner here, and there are more files to grow with."""
WARM_UP = 0.2
"""Part of the samples that is left out."""


@dataclass(frozen=True)
class Sample:
    """One process, or the whole session, at one time."""

    minute: float
    of: str
    cpu_percent: float = 0.0
    """Of one core, since the sample before."""
    memory_mb: float = 0.0
    descriptors: float = 0.0
    threads: float = 0.0
    shared_memory_mb: float = 0.0
    tick_p50_ms: float = 0.0
    tick_p99_ms: float = 0.0
    late_ticks_percent: float = 0.0
    """Of all ticks so far, those that took more than a millisecond."""


class Processes:
    """The processes of a session, by name."""

    def __init__(self) -> None:
        self._cpu: dict[int, tuple[float, float]] = {}
        """By process id: when it was looked at, and what it had used by then, s."""

    def sample(self, minute: float, name: str, process: int) -> Sample:
        """A process by its id."""
        descriptors, threads = (len(list(Path(f'/proc/{process}/{kind}').iterdir())) for kind in ('fd', 'task'))
        return Sample(minute, name, cpu_percent=self._cpu_percent(process),
                      memory_mb=memory_bytes(process) / 2**20, descriptors=descriptors, threads=threads)

    def _cpu_percent(self, process: int) -> float:
        now, used = time.monotonic(), cpu_seconds(process)
        before, used_before = self._cpu.get(process, (now, used))
        self._cpu[process] = now, used
        return 100.0 * (used - used_before) / (now - before) if now > before else 0.0


def shared_memory_mb() -> float:
    """What the files in /dev/shm take."""
    sizes = []
    for file in Path('/dev/shm').iterdir():
        try:
            sizes.append(file.stat().st_blocks * 512)
        except FileNotFoundError:
            continue
    return sum(sizes) / 2**20


def growth(samples: list[Sample]) -> list[str]:
    """What grows, in words."""
    found = []
    for name in dict.fromkeys(sample.of for sample in samples):
        own = [sample for sample in samples if sample.of == name]
        own = own[int(WARM_UP * len(own)):]
        minutes = np.array([sample.minute for sample in own])
        for figure, allowed in ALLOWED.items():
            values = np.array([getattr(sample, figure) for sample in own])
            slope, error = _slope(minutes, values)
            if slope > allowed and slope > 3 * error:
                found.append(f'{name}: {figure} grows by {slope:.4f} a minute (standard error {error:.4f}), '
                             f'from {values[0]:.2f} to {values[-1]:.2f}; allowed {allowed}')
    return found


def _slope(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Of a straight line by least squares, and its standard error."""
    if len(x) < 3:
        return 0.0, float('inf')
    design = np.stack([x - x.mean(), np.ones(len(x))], axis=1)
    (slope, level), *_ = np.linalg.lstsq(design, y, rcond=None)
    residual = y - design @ (slope, level)
    return float(slope), float(np.sqrt(residual @ residual / (len(x) - 2) / (design[:, 0] @ design[:, 0])))


def soak(minutes: float, every: float, folder: Path, domain: int) -> list[Sample]:
    """Samples of a session of so many minutes, taken every ``every`` minutes; an interrupt ends it early."""
    observer = Observer(domain)
    diagnostics = observer.listen(contract.DIAGNOSTICS, 100)
    log = (folder / 'session.log').open('w')
    parameters = folder / 'parameters.yaml'
    parameters.write_text(PARAMETERS)
    session = Session(['--tutor', 'sim', '--minutes', str(minutes + 2), '--episodes', '0', '--test-episodes', '0',
                       '--params-file', str(parameters), '--output', str(folder / 'session')], stdout=log, stderr=log)
    samples: list[Sample] = []
    processes = Processes()
    try:
        observer.spin(lambda: _ticks(diagnostics), 120.0, 'ticks of the simulator')
        begin = time.monotonic()
        _look(processes, session, 0.0)
        for number in tqdm(range(1, int(minutes / every) + 1), unit='sample', disable=None):
            while time.monotonic() < begin + 60 * every * number:
                observer.spin_for(0.5)
            if session.process.poll() is not None:
                raise SystemExit(f'the session ended early: {(folder / "session.log").read_text()[-2000:]}')
            minute = every * number
            fresh = _look(processes, session, minute)
            fresh.append(Sample(minute, 'all', shared_memory_mb=shared_memory_mb(), **(_ticks(diagnostics) or {})))
            diagnostics.clear()
            for sample in fresh:
                print('  '.join(f'{name} {value:.2f}' if isinstance(value, float) else f'{value:24}'
                                for name, value in asdict(sample).items() if value), flush=True)
            samples += fresh
    except KeyboardInterrupt:
        print('interrupted')
    finally:
        session.close()
        observer.close()
        log.close()
    return samples


def _look(processes: Processes, session: Session, minute: float) -> list[Sample]:
    """A sample of each node, and of the session itself."""
    nodes = {name: process for name in NODES if (process := session.node(name))}
    return [processes.sample(minute, name, process)
            for name, process in {**nodes, 'session': session.process.pid}.items()]


def _ticks(diagnostics: list[DiagnosticArray]) -> dict[str, float] | None:
    """The simulator's newest report of its ticks, as figures of a sample."""
    for message in reversed(diagnostics):
        for status in message.status:
            values = values_of(status)
            if status.name.endswith('panda_sim_node') and 'tick_p50_ms' in values:
                return {'tick_p50_ms': float(values['tick_p50_ms']), 'tick_p99_ms': float(values['tick_p99_ms']),
                        'late_ticks_percent': 100.0 * int(values['late_ticks']) / max(int(values['ticks']), 1)}
    return None


def main() -> int:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--minutes', type=float, default=60.0, metavar='MIN', help='how long the session lasts')
    parser.add_argument('--every', type=float, default=1.0, metavar='MIN', help='time between two samples')
    parser.add_argument('--output', type=Path, default=Path('out/soak.json'), metavar='FILE',
                        help='file for the figures')
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, free_domain() as domain:
        samples = soak(args.minutes, args.every, Path(folder), domain)
    found = growth(samples)
    print('\n'.join(found) or f'nothing grows in {samples[-1].minute if samples else 0.0:g} minutes')
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps({'growth': found, 'samples': [asdict(sample) for sample in samples]}, indent=2))
    print(f'written to {args.output}')
    return int(bool(found))


if __name__ == '__main__':
    sys.exit(main())
