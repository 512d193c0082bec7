"""``shared-control view``: a session in Rerun: arm, ball, moments, keys, phases and charts on one time line."""

import argparse
from pathlib import Path


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``view`` to the ``shared-control`` command."""
    parser = commands.add_parser('view', help='open a recorded session in Rerun', description=__doc__)
    parser.add_argument('bag', type=Path, help="a session's folder, its bag's folder, or a single MCAP file")
    parser.add_argument('--save', type=Path, metavar='FILE.rrd', default=None,
                        help='write the recording there (`rerun FILE.rrd` opens it) instead of opening the viewer')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Open or write a recording; the exit code."""
    # Imported late: the viewer's package is large, and an extra.
    try:
        import rerun as rr
    except ModuleNotFoundError as error:
        raise ValueError('view needs Rerun: pip install "shared-control[view]"') from error
    from ..bag.reader import read_bag
    from ..session.folder import SessionFolder
    from .recording import blueprint, log_bag
    is_bag = args.bag.is_file() or (args.bag / 'metadata.yaml').is_file() or not SessionFolder(args.bag).bag.is_dir()
    path = args.bag if is_bag else SessionFolder(args.bag).bag
    bag = read_bag(path)
    recording = rr.RecordingStream('shared_control', recording_id=str(path.absolute()))
    if args.save is None:
        recording.spawn(default_blueprint=blueprint(bag))
    else:
        recording.save(args.save, default_blueprint=blueprint(bag))
    log_bag(bag, recording)
    recording.flush()
    if args.save is not None:
        print(args.save)
    return 0
