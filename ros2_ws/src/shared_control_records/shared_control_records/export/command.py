# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""``shared-control export``: bags of sessions as Parquet or as a LeRobot data set, at the policy's rate (50 Hz)."""

import argparse
from pathlib import Path

from shared_control.command_line import add_parser
from shared_control.files import refuse_another_file
from shared_control.plugins import TASKS, load, names

FORMATS = ('parquet', 'lerobot')


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``export`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'export', run, summary='write sessions as Parquet or as a LeRobot data set',
        description="Write sessions as one table or data set, at the policy's rate (50 Hz).",
        examples=['shared-control export out/demo',
                  'shared-control export out/sessions/p1 out/sessions/p2 --format lerobot --output out/data_set'])
    parser.add_argument('sessions', type=Path, nargs='+', metavar='SESSION',
                        help="a session's folder, its bag's folder, or an MCAP file; several become one data set, "
                             'in which they go by the names of their folders, or by paths where names are alike')
    parser.add_argument('--format', choices=FORMATS, default='parquet', help='Parquet file, or LeRobot data set')
    parser.add_argument('--output', type=Path, default=None, metavar='PATH',
                        help='file (parquet) or new folder (lerobot) (default: beside the first bag)')
    parser.add_argument('--task', choices=names(TASKS), default=None,
                        help='what was learned, for bags that do not say it (default: what the bag says, or balance)')


def run(args: argparse.Namespace) -> int:
    """Export bags; the exit code."""
    # Imported late: pyarrow and the robot's model take a second, which `--help` need not wait for.
    from ..bag.files import find_bag
    from ..bag.reader import read_bag, read_task
    from .frames import check_alike, episode_frames, session_names
    from .lerobot import refuse_filled, write_lerobot
    from .parquet import MAGIC, write_parquet
    suffix = '.parquet' if args.format == 'parquet' else '_lerobot'
    bags = [find_bag(path) for path in args.sessions]
    sessions = session_names(bags)
    output = args.output or bags[0].absolute().with_name(bags[0].stem + suffix)
    if args.format == 'parquet':
        refuse_another_file(output, 'Parquet file', MAGIC)
    else:
        refuse_filled(output)
    task = load(TASKS, args.task)() if args.task else None
    if task is None and len(bags) > 1:  # before the first is read, which takes a while
        check_alike((session, read_task(bag).name) for session, bag in zip(sessions, bags, strict=True))
    episodes = [frames for session, bag in zip(sessions, bags, strict=True)
                for frames in episode_frames(read_bag(bag, task), session)]
    if args.format == 'parquet':
        write_parquet(episodes, output)
    else:
        write_lerobot(episodes, output)
    print(f'{sum(map(len, episodes))} frames of {len(episodes)} episodes in {output}')
    return 0
