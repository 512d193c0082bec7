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

"""A healthy machine and five sick ones, made so for real, for ``shared-control doctor``: its tests and its page.

    python -m shared_control_testing.machines > docs/reference/doctor.md
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from shared_control_testing.nodes import RunningNode, free_domain

PAGE = """# The doctor's findings

What `shared-control doctor` prints on a machine where a session runs, and on five that were made sick on purpose; of
those what is wrong. Written by `python -m shared_control_testing.machines`, which makes the machines so for real,
as do the tests of the command.
"""


@dataclass(frozen=True)
class Machine:
    """What is done to a machine before the doctor comes."""

    title: str
    done: str
    """In words."""
    subject: str = ''
    """The beginning of the line that says what is wrong; empty when nothing is."""
    under: tuple[str, ...] = ()
    """The command that starts the doctor."""
    variables: dict[str, str] = field(default_factory=dict)
    node: bool = False
    """Whether a simulator runs in the domain."""


HEALTHY = Machine('A healthy machine', 'Nothing was done to it.')
VARIABLES = Machine(
    'Variables of another shell', 'Another middleware is asked for, and a profile that is not there.',
    'FASTRTPS_DEFAULT_PROFILES_FILE',
    variables={'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp', 'FASTRTPS_DEFAULT_PROFILES_FILE': '/no/profile.xml'})
DOMAIN = Machine('A domain that is taken', 'A simulator runs in it.', 'ROS, domain', node=True)
SHARED_MEMORY = Machine(
    'A full /dev/shm', 'It has 64 MB, as in a container of Docker, and somebody has filled it.', '/dev/shm',
    ('unshare', '--mount', 'sh', '-c', 'mount -t tmpfs -o size=64m tmpfs /dev/shm && '
     '{ head -c 64m /dev/zero > /dev/shm/left_behind; exec "$@"; }', '-'))
NO_REAL_TIME = Machine(
    'No real-time limit', 'The user may give no process real-time priority.', 'real-time priority',
    # Who has the capability needs no limit.
    (*(('setpriv', '--bounding-set=-sys_nice', '--inh-caps=-sys_nice') if os.geteuid() == 0 else ()),
     'prlimit', '--rtprio=0:0'))
NO_BROWSER = Machine('No Chromium', 'No browser is on `PATH`.', 'Chromium', variables={'PATH': '/no/programs'})
SICK = (VARIABLES, DOMAIN, SHARED_MEMORY, NO_REAL_TIME, NO_BROWSER)


def examine(machine: Machine, env: dict[str, str]) -> tuple[int, str]:
    """Exit code of the doctor, started in the environment ``env``, and what it prints.

    Raises:
        RuntimeError: it said something on standard error.
    """
    under = [*machine.under]
    if under and os.sep not in under[0]:  # PATH may be one of the things that are missing
        under[0] = next(str(path) for folder in os.environ['PATH'].split(os.pathsep)
                        if (path := Path(folder) / under[0]).exists())
    done = subprocess.run([*under, sys.executable, '-m', 'shared_control', 'doctor'], stdin=subprocess.DEVNULL,
                          env={**env, **machine.variables}, capture_output=True, text=True, timeout=300, check=False)
    if done.stderr:
        raise RuntimeError(done.stderr)
    return done.returncode, done.stdout


def wrong(output: str) -> Iterator[str]:
    """The lines that are not ``ok``, each with the remedy below it; but for cores, which are busy by chance."""
    shown = False
    for line in output.splitlines():
        found = line.startswith(('note', 'FAULT')) and not line[7:].startswith('cores')
        shown = found or (shown and line.startswith(' ' * 9))
        if shown:
            yield line


@contextmanager
def _neighbour(machine: Machine) -> Iterator[None]:
    with tempfile.TemporaryDirectory() as folder:
        node = RunningNode('panda_sim_node', '', {}, Path(folder) / 'log') if machine.node else None
        try:
            if node:
                node.wait_for_log('ready')
            yield
        finally:
            if node:
                node.stop()


def main() -> None:
    """Print the page."""
    own = {name: value for name, value in os.environ.items() if not name.startswith(('ROS_', 'RMW_', 'FASTRTPS_'))}
    print(PAGE)
    with free_domain() as domain:
        for machine in (HEALTHY, *SICK):
            with _neighbour(machine):
                code, output = examine(machine, {**own, 'ROS_DOMAIN_ID': str(domain)})
            text = '\n'.join(wrong(output)) if machine.subject else output.strip()
            print(f'## {machine.title}\n\n{machine.done} Exit code {code}.\n\n```text\n{text}\n```\n')


if __name__ == '__main__':
    main()
