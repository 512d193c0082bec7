"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse

from .options import add_options


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``session`` to the ``shared-control`` command."""
    parser = commands.add_parser('session', help='teach the robot on the running graph', description=__doc__)
    add_options(parser)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run a session; the exit code."""
    from .session import run as run_session  # late: `--help` need not wait for what reads and writes bags
    return run_session(args)
