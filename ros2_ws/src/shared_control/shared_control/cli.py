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

"""``shared-control``: one command, with subcommands from every installed package.

A package adds its own through the entry-point group ``shared_control.commands``: under the subcommand's name a function
that is given argparse's subparsers and sets the default ``run``, which takes the parsed arguments and returns the exit
code.
"""

import argparse
import os
import signal
import sys
from contextlib import suppress
from importlib.metadata import EntryPoint, entry_points

from .command_line import add_parser, make_parser
from .extras import NotInstalled, missing
from .printable import escaped
from .streams import lossy_output, open_closed_streams

ORDER = ('session', 'replay', 'report', 'view', 'export', 'recover', 'train', 'evaluate', 'tutors', 'study', 'validate',
         'doctor')
"""Our commands as they are listed, in the order of use; those of others follow."""


def main() -> int:
    """Entry point."""
    open_closed_streams()
    for number in (signal.SIGTERM, signal.SIGHUP):  # a scheduler's, a closed terminal's: as Ctrl-C, nothing is lost
        if signal.getsignal(number) is signal.SIG_DFL:  # not so under nohup
            signal.signal(number, signal.default_int_handler)
    os.environ.pop('MPLBACKEND', None)  # a notebook's is none that this process has; all pictures are drawn without one
    try:
        with lossy_output():
            return _run()
    except OSError as error:
        with suppress(OSError):
            print(f'shared-control: {error}', file=sys.stderr, flush=True)
        return 2


def _run() -> int:
    parser = make_parser(
        'Teach a robot together with a learning agent. Each command has a --help of its own.',
        ['shared-control session', 'shared-control session --tutor page', 'shared-control doctor'],
        prog='shared-control')
    commands = parser.add_subparsers(title='commands', metavar='COMMAND')
    known = known_commands()
    # Only the one that is asked for, if it is there: some import torch, which takes seconds.
    for entry_point in [e for e in known if e.name == (sys.argv[1:] or [''])[0]] or known:
        try:
            add_command = entry_point.load()
        except ModuleNotFoundError as error:
            _add_missing(commands, entry_point.name, error.name or str(error))
        else:
            add_command(commands)
    args = parser.parse_args()
    if 'run' not in args:
        parser.print_help()
        return 0
    try:
        return args.run(args)
    except KeyboardInterrupt:
        return 130
    except ModuleNotFoundError as error:
        print(f'shared-control: {missing("the command", error)}', file=sys.stderr)
        return 2
    except (ValueError, OSError, NotInstalled) as error:
        print(f'shared-control: {escaped(str(error))}', file=sys.stderr)
        return 2


def known_commands() -> list[EntryPoint]:
    """The commands that installed packages add, in the order in which they are listed."""
    found = sorted(entry_points(group='shared_control.commands'), key=lambda entry: entry.name)
    return sorted(found, key=lambda entry: ORDER.index(entry.name) if entry.name in ORDER else len(ORDER))


def _add_missing(commands: argparse._SubParsersAction, name: str, module: str) -> None:
    """A command whose dependencies are not installed: it says which."""
    text = f'not installed: it needs the module {module!r}; pip install "shared-control[all]" brings all of them'

    def run(_: argparse.Namespace) -> int:
        raise ValueError(f'{name} is {text}')

    command = add_parser(commands, name, run, summary=text, description=text, examples=[f'shared-control {name}'])
    command.add_argument('arguments', nargs=argparse.REMAINDER, help='ignored')
