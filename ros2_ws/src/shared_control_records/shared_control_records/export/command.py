"""``shared-control export``: bags of sessions as Parquet or as a LeRobot data set, at the policy's rate (50 Hz)."""

import argparse
from pathlib import Path

from shared_control.plugins import TASKS, load, names

FORMATS = ('parquet', 'lerobot')


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``export`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'export', help="a session's bag as Parquet or LeRobot data set", description=__doc__,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('bags', type=Path, nargs='+', metavar='BAG',
                        help='bag folder, or a single MCAP file; several become one data set')
    parser.add_argument('--format', choices=FORMATS, default='parquet')
    parser.add_argument('--output', type=Path, default=None,
                        help='file (parquet) or new folder (lerobot); beside the first bag when not given')
    parser.add_argument('--task', choices=names(TASKS), default=None,
                        help='what was learned, for bags that do not say it (default: what the session kept, '
                             'or balance)')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Export bags; the exit code."""
    # Imported late: pyarrow and the robot's model take a second, which `--help` need not wait for.
    from ..bag.reader import read_bag
    from .frames import episode_frames
    from .lerobot import write_lerobot
    from .parquet import write_parquet
    suffix = '.parquet' if args.format == 'parquet' else '_lerobot'
    output = args.output or args.bags[0].absolute().with_name(args.bags[0].stem + suffix)
    task = load(TASKS, args.task)() if args.task else None
    episodes = [frames for bag in args.bags for frames in episode_frames(read_bag(bag, task))]
    if args.format == 'parquet':
        write_parquet(episodes, output)
    else:
        write_lerobot(episodes, output)
    print(f'{sum(map(len, episodes))} frames of {len(episodes)} episodes in {output}')
    return 0
