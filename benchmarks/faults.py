"""A fault campaign: sessions on the live graph, faults at random moments, and what must hold in spite of them.

    python benchmarks/faults.py --faults 200 --minutes 45        # what `make faults` runs
    python benchmarks/faults.py --only 17                         # the fault of that number again, alone

The tutor is simulated and the simulator unpaced. Faults are drawn by a seed: killed, stopped and slowed nodes;
messages repeated, reordered, garbled; packets lost, repeated, reordered and garbled below DDS; the clock of the day set
back and forward, with the robot's time or without; a disk that is full; an emergency stop with a restart of the
controller; Ctrl-C and a resume. After each fault the learner must begin another phase or the session end in order;
after each session its folder is checked: torques within limit and rate, no moment that nobody asked for within its
time-out, the sum that of its parts, the bag readable by rosbags and mcap with at most 1 s lost, the policy loads, table
and bag agree, a report.
"""

import json
import sys
import tempfile
import time
from collections import Counter
from dataclasses import asdict
from pathlib import Path

from shared_control.command_line import script_parser
from shared_control_testing.faults import Campaign, Outcome, draw
from shared_control_testing.nodes import free_domain


def main() -> int:
    """Entry point; the exit code is 1 when something does not hold."""
    parser = script_parser(__doc__)
    parser.add_argument('--faults', type=int, default=200, metavar='N', help='how many')
    parser.add_argument('--seed', type=int, default=0, metavar='N', help='seed of what is drawn')
    parser.add_argument('--minutes', type=float, default=45.0, metavar='MIN', help='begin no fault after that')
    parser.add_argument('--only', type=int, metavar='N', help='the fault of this number alone (default: all)')
    parser.add_argument('--keep', type=Path, metavar='FOLDER', help='keep the sessions there (default: thrown away)')
    parser.add_argument('--output', type=Path, default=Path('out/faults.json'), metavar='FILE',
                        help='file for the findings')
    args = parser.parse_args()
    faults = draw(args.seed, max(args.faults, (args.only or 0) + 1))
    if args.only is not None:
        faults = [faults[args.only]]
    with tempfile.TemporaryDirectory() as scratch, free_domain() as domain:
        campaign = Campaign(faults, args.keep or Path(scratch), domain, lambda line: print(line, flush=True))
        try:
            campaign.run(time.monotonic() + 60 * args.minutes)
        except KeyboardInterrupt:
            print('interrupted: what follows is of the sessions that had ended')
    outcomes = campaign.outcomes
    print(table(outcomes))
    judged = [outcome for outcome in outcomes if outcome.judged]
    print(f'{len(outcomes)} of {len(faults)} faults, {sum(len(o.violations) for o in judged)} violations; '
          f"{len(outcomes) - len(judged)} not judged, since the campaign's own process stood still or failed")
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps([asdict(outcome) for outcome in outcomes], indent=2) + '\n')
    print(f'written to {args.output}')
    return int(len(outcomes) < len(faults) or any(outcome.violations for outcome in outcomes))


def table(outcomes: list[Outcome]) -> str:
    """Faults and violations by kind and target."""
    faults = Counter((outcome.fault.kind, outcome.fault.target) for outcome in outcomes)
    wrong = Counter((outcome.fault.kind, outcome.fault.target) for outcome in outcomes if outcome.violations)
    rows = [f'{kind:16} {target:24} {count:6} {wrong[kind, target]:10}'
            for (kind, target), count in sorted(faults.items())]
    return '\n'.join([f'{"fault":16} {"of":24} {"number":>6} {"violations":>10}', *rows])


if __name__ == '__main__':
    sys.exit(main())
