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

"""One style of help for every command: what it does, options with their defaults, examples. Imports nothing heavy."""

import argparse
import json
import re
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, TextIO

from .files import refuse_another_file, write_atomically

EXAMPLES = 'Examples:'
TO_THE_OUTPUT = Path('-')
"""A file of this name is standard output."""


class _Help(argparse.ArgumentDefaultsHelpFormatter):
    """Shows defaults once; wraps paragraphs, and leaves indented lines as they are."""

    def _get_help_string(self, action: argparse.Action) -> str | None:
        has_none = action.default is None or action.default is False or action.default == ''
        return action.help if has_none or '(default' in (action.help or '') else super()._get_help_string(action)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return '\n\n'.join(
            part if re.search('^ ', part, re.MULTILINE) else super(_Help, self)._fill_text(part, width, indent)
            for part in text.strip('\n').split('\n\n'))


def make_parser(description: str, examples: Sequence[str], *, prog: str | None = None) -> argparse.ArgumentParser:
    """A parser of a command of its own.

    Args:
        description: plain text; indented paragraphs stay as they are.
        examples: whole commands that work.
        prog: its name; that of the program when not given.
    """
    parser = argparse.ArgumentParser(prog=prog, **_texts(description, examples))
    _add_to_every(parser)
    return parser


def script_parser(doc: str) -> argparse.ArgumentParser:
    """A parser of a script that is run by its path, from its docstring, of which a paragraph is indented: examples.

    Raises:
        ValueError: none is.
    """
    paragraphs = doc.strip('\n').split('\n\n')
    examples = [part for part in paragraphs if part.startswith('    ')]
    if not examples:
        raise ValueError('the docstring of a script needs an indented paragraph: examples')
    about = '\n\n'.join(part for part in paragraphs if part not in examples).replace('`', '')
    return make_parser(about, [line.strip().replace('`', '') for part in examples for line in part.splitlines()])


def add_parser(commands: argparse._SubParsersAction, name: str, run: Callable[[argparse.Namespace], int], *,
               summary: str, description: str, examples: Sequence[str]) -> argparse.ArgumentParser:
    """Add a command to ``shared-control``, and give its parser, for its options.

    Args:
        commands: argparse's subparsers.
        run: takes the parsed arguments, returns the exit code; stored as the default ``run``.
        summary: for the list of commands.
        description: plain text; indented paragraphs stay as they are.
        examples: whole commands that work.
    """
    parser: argparse.ArgumentParser = commands.add_parser(name, help=summary, **_texts(description, examples))
    _add_to_every(parser)
    parser.set_defaults(run=run)
    return parser


def add_json_option(parser: argparse.ArgumentParser, what: str) -> None:
    """Add ``--json FILE``.

    Args:
        what: it holds, as in ``all figures``.
    """
    parser.add_argument('--json', type=_json_file, metavar='FILE',
                        help=f'write {what} to this file; - for standard output (default: not written)')


def _json_file(name: str) -> Path:
    """Where JSON may be written; checked before the work begins."""
    path = _path(name)
    if path != TO_THE_OUTPUT:
        try:
            refuse_another_file(path, 'JSON file', b'{')
        except OSError as error:
            raise argparse.ArgumentTypeError(str(error)) from error
    return path


def _path(name: str) -> Path:
    """A path that an option gives: an empty one would be the folder that somebody happens to be in."""
    if not name:
        raise argparse.ArgumentTypeError('the path is empty: is the variable set that it comes from?')
    return Path(name)


def prose(json_path: Path | None) -> TextIO:
    """Where a command prints what people read: standard output, unless ``--json -`` has it."""
    return sys.stderr if json_path == TO_THE_OUTPUT else sys.stdout


def write_json(content: Any, path: Path | None) -> None:
    """Write JSON as a whole or not at all: what ``--json`` asks for, if it does, or what a script found.

    Raises:
        OSError: the file cannot be written.
    """
    if path is None:
        return
    text = json.dumps(content, indent=2, allow_nan=False) + '\n'
    if path == TO_THE_OUTPUT:
        sys.stdout.write(text)
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, text.encode())


def version_text(program: str) -> str:
    """What ``--version`` prints."""
    return f'{program} {version("shared-control")}'


def _texts(description: str, examples: Sequence[str]) -> dict[str, Any]:
    return {'description': description, 'formatter_class': _Help,
            'epilog': '\n'.join([EXAMPLES, *(f'  {example}' for example in examples)])}


def _add_to_every(parser: argparse.ArgumentParser) -> None:
    parser.register('type', Path, _path)  # for every option with `type=Path`
    parser.add_argument('--version', action='version', version=version_text('shared-control'),
                        help='print the version and exit')
