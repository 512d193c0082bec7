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

"""``shared-control replay``: a recorded session on the page, with a time slider and speed. Needs no ROS."""

import argparse
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from shared_control.command_line import add_parser
from shared_control_ros.host_and_port import host_and_port

if TYPE_CHECKING:
    from shared_control_records.bag.reader import Bag
    from shared_control_records.session.folder import SessionFolder

FRAME_RATE = 40.0
"""Hz"""


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``replay`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'replay', run, summary='play a recorded session in the browser',
        description='Play a recorded session on the page, with a time slider and speed. Needs no ROS.',
        examples=['shared-control replay out/demo', 'shared-control replay out/demo --page 127.0.0.1:8200'])
    parser.add_argument('session', type=Path, metavar='SESSION',
                        help="a session's folder, its bag's folder, or an MCAP file")
    parser.add_argument('--page', type=host_and_port, default='127.0.0.1:8089', metavar='HOST:PORT',
                        help='where the page is served; another host than loopback opens it to the network, '
                        'with a token')


def run(args: argparse.Namespace) -> int:
    """Serve the replay until Ctrl-C; the exit code."""
    # Imported late: `--help` and the other commands need neither web server nor bag reader.
    import asyncio

    from shared_control_records.bag.files import find_bag
    from shared_control_records.bag.reader import read_bag
    from shared_control_records.session.folder import SessionFolder

    from .recording import Recording
    from .replay_desk import ReplayDesk
    from .server import PageServer
    from .showing import Showing
    path = find_bag(args.session)
    folder = None if path == args.session else SessionFolder.open(args.session)
    print(f'Reading {path} ...', flush=True)
    host, port = args.page
    bag = read_bag(path)
    recording = Recording(bag)
    showing = Showing(title=_title(args.session, folder, bag), marks=tuple(recording.marks()), tested=_tested(folder))
    server = PageServer(ReplayDesk(recording, showing), host, port, FRAME_RATE)
    print(f'\n    Watch here: {server.address}\n\nCtrl-C ends the replay.', flush=True)
    with suppress(KeyboardInterrupt):  # that is how a replay ends
        asyncio.run(server.serve(lambda: False))
    return 0


def _title(given: Path, folder: 'SessionFolder | None', bag: 'Bag') -> str:
    """Which recording it is: folder, day, tutor."""
    parts = [given.resolve().name, f'{datetime.fromtimestamp(bag.start_ns * 1e-9):%Y-%m-%d %H:%M}']
    settings = None if folder is None else folder.read_json(folder.settings)
    if settings and settings.get('tutor'):
        parts.append(f'tutor: {settings["tutor"]}')
    return ' · '.join(parts)


def _tested(folder: 'SessionFolder | None') -> str:
    """What the final test came to; empty: there was none."""
    from shared_control_records.session.final_test import load_test
    test = None if folder is None else load_test(folder.test)
    return '' if test is None else f'{test.successes} of {len(test.episodes)} tests'
