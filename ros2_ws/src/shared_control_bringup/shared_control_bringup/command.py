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

"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse

from shared_control.command_line import add_parser

from .options import add_options


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``session`` to the ``shared-control`` command."""
    add_options(add_parser(
        commands, 'session', run, summary='teach the robot',
        description='Teach the robot on the running graph, keep everything in one folder (bag, policy, settings, '
                    'report), and test what it has learned. Stopped, by whatever, it goes on with --resume.',
        examples=['shared-control session', 'shared-control session --tutor page --task plate --minutes 10',
                  'shared-control session --tutor sim --profile low --episodes 12 --no-screen',
                  'shared-control session --resume out/sessions/monday --episodes 20']))


def run(args: argparse.Namespace) -> int:
    """Run a session; the exit code."""
    from .session import run as run_session  # late: `--help` need not wait for what reads and writes bags
    return run_session(args)
