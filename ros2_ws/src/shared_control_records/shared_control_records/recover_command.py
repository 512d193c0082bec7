"""``shared-control recover``: finish what a killed recorder left, its own or that of ``ros2 bag record``."""

import argparse
from pathlib import Path


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``recover`` to the ``shared-control`` command."""
    parser = commands.add_parser('recover', help='finish the bag of a killed recorder', description=__doc__)
    parser.add_argument('bag', type=Path, help="the bag's folder")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Recover a bag; the exit code."""
    from .bag import recover  # late: `--help` need not wait for what reads bags
    recovered = recover(args.bag)
    for file in recovered:
        print(file)
    if not recovered:
        print(f'{args.bag}: every file is whole')
    return 0
