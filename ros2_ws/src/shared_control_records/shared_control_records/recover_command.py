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

"""``shared-control recover``: finish what a killed recorder left, its own or that of ``ros2 bag record``."""

import argparse
from pathlib import Path

from shared_control.command_line import add_parser


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``recover`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'recover', run, summary='finish the bag of a killed recorder',
        description='Finish the bag that a killed recorder left, that of a session or of ros2 bag record. Nothing that '
                    'was recorded is lost; a bag that is whole is left as it is.',
        examples=['shared-control recover out/demo'])
    parser.add_argument('session', type=Path, metavar='SESSION', help="a session's folder, or its bag's folder")


def run(args: argparse.Namespace) -> int:
    """Recover a bag; the exit code."""
    from .bag import recover  # late: `--help` need not wait for what reads bags
    from .bag.files import check_is_bag, find_bag
    bag = find_bag(args.session)
    check_is_bag(bag)
    recovered = recover(bag)
    for file in recovered:
        print(file)
    if not recovered:
        print(f'{bag}: every file is whole')
    return 0
