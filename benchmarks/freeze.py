"""Whether a loop of real-time priority can stand still for ever, beside a load: as nodes had it, and as they have it.

    python benchmarks/freeze.py --minutes 60        # what `make freeze MINUTES=60` runs

Fast DDS has a thread that spins on a lock. At the priority of the loop, on the core of the loop, it once kept the
loop, which held that lock, from ever running again, and the session stood still. Here is a loop with such a thread.
With the priorities of then it freezes within seconds, and the watchdog ends it; with those of today it has to come
round for all the minutes, while other processes want the same core. Needs root, or `ulimit -r`.
"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

from shared_control.command_line import script_parser
from shared_control.files import write_atomically
from shared_control.processes import leave_with_the_parent
from shared_control_testing.standstill import AS_IT_WAS, AS_NODES_HAVE_IT, run_loop

LOADS_A_CORE = 2


def main() -> int:
    """Entry point; the exit code is 1 when the loop of today stands still, or that of then does not."""
    parser = script_parser(__doc__)
    parser.add_argument('--minutes', type=float, default=60.0, metavar='MIN',
                        help='how long the loop of today has to come round')
    parser.add_argument('--output', type=Path, default=Path('out/freeze.json'), metavar='FILE',
                        help='file for the figures')
    args = parser.parse_args()
    busy = [subprocess.Popen([sys.executable, '-c', 'while True: pass'], preexec_fn=leave_with_the_parent)
            for _ in range(LOADS_A_CORE * len(os.sched_getaffinity(0)))]
    try:
        print(f'beside {len(busy)} processes that are always busy', flush=True)
        before, _ = run_loop(AS_IT_WAS, 60.0)
        froze = before == -signal.SIGALRM
        print(f'{AS_IT_WAS}: {"froze within a minute; the watchdog ended it" if froze else f"exit code {before}"}',
              flush=True)
        now, rounds = run_loop(AS_NODES_HAVE_IT, 60.0 * args.minutes)
    finally:
        for process in busy:
            process.kill()
            process.wait()
    goes_on = now == 0 and rounds > 0
    print(f'{AS_NODES_HAVE_IT}: ' + (
        f'came round {rounds} times in {args.minutes:g} minutes' if goes_on else f'stood still (exit code {now})'))
    args.output.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(args.output, (json.dumps(
        {'minutes': args.minutes, 'froze_before': froze, 'goes_on': goes_on, 'rounds': rounds}) + '\n').encode())
    print(f'written to {args.output}')
    return int(not (froze and goes_on))


if __name__ == '__main__':
    sys.exit(main())
