"""``shared-control``: one command, with subcommands from every installed package.

A package adds its own through the entry-point group ``shared_control.commands``: a function that is given
argparse's subparsers and sets the default ``run``, which takes the parsed arguments and returns the exit code.
"""

import argparse
import sys
from importlib.metadata import entry_points


def main() -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(
        prog='shared-control', description='Teach a robot together with a learning agent.')
    commands = parser.add_subparsers(title='commands', metavar='COMMAND', required=True)
    for entry_point in sorted(entry_points(group='shared_control.commands'), key=lambda e: e.name):
        entry_point.load()(commands)
    args = parser.parse_args()
    try:
        return args.run(args)
    except KeyboardInterrupt:
        return 130
    except (ValueError, OSError) as error:
        print(f'shared-control: {error}', file=sys.stderr)
        return 2
