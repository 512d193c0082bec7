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

"""``shared-control validate``: the thesis' validation of kinematics, dynamics and control (2.2-2.4), redone."""

import argparse
from pathlib import Path

from shared_control.command_line import add_json_option, add_parser, prose, write_json
from shared_control.files import refuse_unwritable


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``validate`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'validate', run, summary='check model and controller against the thesis',
        description='Redo the validation of kinematics, dynamics and control of the thesis (sections 2.2 to 2.4): the '
                    'tray follows cosine references, with the high and low gains of Table 3, with and without the '
                    'non-linear terms; the model is compared with kinematics and dynamics written down by hand. The '
                    'exit code is 1 when something disagrees.',
        examples=['shared-control validate', 'shared-control validate --output out/mine --json out/mine/figures.json'])
    parser.add_argument('--output', type=Path, metavar='FOLDER', default=Path('out/validation'),
                        help='folder for the figures (PNG, SVG, PDF)')
    add_json_option(parser, 'all figures of the tables')


def run(args: argparse.Namespace) -> int:
    """Validate; the exit code."""
    # Imported late: pinocchio and matplotlib take a second, which `--help` need not wait for.
    from tqdm import tqdm

    from ..plotting.plot import origin, write_captions
    from .figures import plots
    from .run import validate
    refuse_unwritable(args.output)
    args.output.mkdir(parents=True, exist_ok=True)
    validation = validate()
    print(validation.table(), file=prose(args.json))
    found = list(plots(validation.runs))
    write_captions(found, args.output / 'captions.md')
    for plot in tqdm(found, unit='figure', desc='figures', disable=None):
        plot.save(args.output, origin())
    print(f'Figures are in {args.output}', file=prose(args.json))
    write_json(validation.as_json(), args.json)
    return 0 if validation.passed else 1
