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

"""The command of a node: its help at once, and everything else from its module."""

import ast
import re
import sys
import textwrap
from importlib import import_module
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path

from shared_control.command_line import EXAMPLES, version_text
from shared_control.printable import shortened

from .declarations import declarations_of

WIDTH = 100
INDENT = ' ' * 8


def run_node(module: str) -> int:
    """``main()`` of the module, or what ``--help`` and ``--version`` ask for: that waits for no import of a second.

    Returns: the exit code; 2 where there are arguments that are none for ROS: whoever forgot ``--ros-args`` before
        ``-p moment_limit:=5.0`` would have the default.
    """
    program = Path(sys.argv[0]).name
    if program == '__main__.py':  # python -m
        program = module.rpartition('.')[0]
    asked = {*sys.argv[1:]}
    if {'-h', '--help'} & asked:
        print(help_text(program, module))
        return 0
    if '--version' in asked:
        print(version_text(program))
        return 0
    if others := list(takewhile(lambda argument: argument != '--ros-args', sys.argv[1:])):
        print(f'error: {program} takes no {" ".join(map(shortened, others))}: parameters and remappings stand behind '
              '--ros-args, as in --ros-args -p NAME:=VALUE', file=sys.stderr)
        return 2
    return import_module(module).main()


def help_text(program: str, module: str) -> str:
    """The help of a node: the docstring of its module without its markup, its parameters with their defaults, examples.

    Args:
        program: name of its executable.
        module: is read, not imported; its parameters are those that its package declares.
    """
    spec = find_spec(module)
    assert spec is not None and spec.origin is not None, module
    package = module.rpartition('.')[0]
    description = re.sub('`+', '', ast.get_docstring(ast.parse(Path(spec.origin).read_text(encoding='utf-8'))) or '')
    lines = [f'usage: {program} [-h] [--version] [--ros-args [-p NAME:=VALUE ...] [--params-file FILE]]', '',
             description, '', 'options:',
             '  -h, --help  show this help message and exit', '  --version   print the version and exit',
             '  --ros-args  what follows is for ROS: parameters, remappings, namespace', '']
    if found := declarations_of(package):
        lines += ['parameters:']
        for parameter in found:
            text = f'{re.sub("`+", "", parameter.description)} (default: {parameter.shown})'
            lines += [f'  {parameter.name}', *textwrap.wrap(text, WIDTH, initial_indent=INDENT,
                                                            subsequent_indent=INDENT)]
        lines += ['']
    executable = f'ros2 run {package.partition(".")[0]} {program}'
    lines += [EXAMPLES, f'  {executable}', f'  {executable} --ros-args --params-file my_parameters.yaml']
    return '\n'.join(lines)
