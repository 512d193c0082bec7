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

"""``shared-control view``: a session in Rerun: arm, ball, moments, keys, phases and charts on one time line."""

import argparse
from pathlib import Path

from shared_control.command_line import add_parser
from shared_control.files import refuse_another_file


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``view`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'view', run, summary='open a recorded session in Rerun',
        description='Open a recorded session in Rerun: arm, ball, moments, keys, phases and charts on one time line.',
        examples=['shared-control view out/demo', 'shared-control view out/demo --output out/demo.rrd'])
    parser.add_argument('session', type=Path, metavar='SESSION',
                        help="a session's folder, its bag's folder, or an MCAP file")
    parser.add_argument('--output', type=Path, metavar='FILE', default=None,
                        help='write the recording there (FILE.rrd) instead of opening the viewer (default: open it)')


def run(args: argparse.Namespace) -> int:
    """Open or write a recording; the exit code."""
    # Imported late: the viewer's package is large, and an extra.
    try:
        import rerun as rr
    except ModuleNotFoundError as error:
        raise ValueError('view needs Rerun: pip install "shared-control[view]"') from error
    from ..bag.files import find_bag
    from ..bag.reader import read_bag
    from .recording import blueprint, log_bag
    if args.output is not None:
        refuse_another_file(args.output, 'recording of Rerun', b'RRF')
    bag = read_bag(find_bag(args.session))
    # The same session is the same recording, wherever it lies: recordings are passed on, and paths name a home.
    recording = rr.RecordingStream('shared_control', recording_id=f'{bag.start_ns}-{bag.end_ns}')
    if args.output is None:
        recording.spawn(default_blueprint=blueprint(bag))
    else:
        recording.save(args.output, default_blueprint=blueprint(bag))
    log_bag(bag, recording)
    recording.flush()
    if args.output is not None:
        print(args.output)
    return 0
