"""``shared-control study``: participants x conditions from one YAML file; docs/how_to/study.md."""

import argparse
import os
from pathlib import Path


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``study`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'study', help='participants x conditions, from one YAML file', description=__doc__,
        epilog='Stopped, by whatever, it goes on where it was when the same command is given again.')
    parser.add_argument('plan', type=Path, help='YAML file; studies/ has examples')
    parser.add_argument('--output', type=Path, default=None, help='folder of the study; default: out/studies/NAME')
    parser.add_argument('--workers', type=int, default=len(os.sched_getaffinity(0)),
                        help='processes on this machine (default: %(default)s)')
    parser.add_argument('--ray', metavar='ADDRESS', default=None,
                        help='do the runs on this Ray cluster instead ("auto": the one running here)')
    parser.add_argument('--participant', type=int, metavar='NUMBER', default=None,
                        help='lead this real participant through what is left to do')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Do what is left of a study; the exit code."""
    from .folder import StudyFolder
    from .people import INTERRUPTED, lead_through
    from .run import do_runs
    if args.workers < 1:
        raise ValueError(f'--workers is {args.workers}, expected at least 1')
    folder = StudyFolder(args.output or Path('out/studies') / args.plan.stem)
    plan = folder.begin(args.plan, args.participant)
    if args.participant is not None:
        if plan.people is None:
            raise ValueError(f'the participants of {args.plan} are simulated: leave --participant out')
        return 0 if lead_through(folder, plan, plan.participant(args.participant)) else INTERRUPTED
    who = 'simulated' if plan.people is None else 'real'
    print(f'{len(plan.participants)} {who} participants x {len(plan.conditions)} conditions in {folder.path}',
          flush=True)
    do_runs(folder, plan, args.workers, args.ray)
    print(f'The report:\n  shared-control report {folder.path}')
    return 0
