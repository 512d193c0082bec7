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

"""``shared-control doctor``."""

import argparse
import os
import re
from collections.abc import Iterator

from shared_control.command_line import add_parser

from . import machine
from .finding import Finding, Level
from .middleware import middleware
from .variables import variables


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``doctor`` to argparse's subparsers."""
    add_parser(
        commands, 'doctor', run, summary='check this machine, and print what to mend',
        description='Check this machine: versions, variables, cores, real-time limits, shared memory, browser, '
                    'middleware and domain. Prints a line for each and the remedy where something is wrong; changes '
                    'nothing. The exit code is 1 when a session would not run.',
        examples=['shared-control doctor'])


def findings() -> Iterator[Finding]:
    """All that is checked, the quick ones first."""
    yield from machine.versions()
    yield from variables()
    yield from machine.cores()
    yield from machine.real_time()
    yield from machine.shared_memory()
    yield from machine.browser()
    yield from middleware()


def for_others(text: str) -> str:
    """A text without the name of this user's home, since reports of a fault are public."""
    home = os.path.expanduser('~').rstrip('/')
    return re.sub(rf'(?<![\w.-]){re.escape(home)}(?![\w.-])', '~', text) if home not in ('', '~') else text


def run(_: argparse.Namespace) -> int:
    """Print what was found and give the exit code."""
    levels = []
    for finding in findings():
        print(for_others(str(finding)), flush=True)
        levels.append(finding.level)
    faults, notes = levels.count(Level.FAULT), levels.count(Level.NOTE)
    print(f'\n{faults} to mend before a session runs, {notes} to note' if faults or notes else '\nnothing to mend')
    return 1 if faults else 0
