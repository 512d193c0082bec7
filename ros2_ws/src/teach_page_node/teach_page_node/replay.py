"""``shared-control replay``: a recorded session on the page, with a time slider and speed. Needs no ROS."""

import argparse
from pathlib import Path

from shared_control_ros.host_and_port import host_and_port

FRAME_RATE = 40.0
"""Hz"""


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``replay`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'replay', help='play a recorded session in the browser', description=__doc__,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('folder', type=Path, metavar='FOLDER', help='of a session, or a bag')
    parser.add_argument('--page', type=host_and_port, default='127.0.0.1:8089', metavar='HOST:PORT',
                        help='where the page is served; another host than loopback opens it to the network, '
                        'with a token')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Serve the replay until Ctrl-C; the exit code."""
    # Imported late: `--help` and the other commands need neither web server nor bag reader.
    import asyncio

    from shared_control_records.bag.reader import read_bag
    from shared_control_records.session.folder import SessionFolder

    from .recording import Recording
    from .replay_desk import ReplayDesk
    from .server import PageServer
    is_bag = args.folder.is_file() or (args.folder / 'metadata.yaml').is_file()
    path = args.folder if is_bag else SessionFolder.open(args.folder).bag
    print(f'Reading {path} ...', flush=True)
    host, port = args.page
    server = PageServer(ReplayDesk(Recording(read_bag(path))), host, port, FRAME_RATE)
    print(f'\n    Watch here: {server.address}\n\nCtrl-C ends the replay.', flush=True)
    asyncio.run(server.serve(lambda: False))
    return 0
