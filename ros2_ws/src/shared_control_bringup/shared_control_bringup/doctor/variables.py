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

"""Checks of the shell's variables that change what the middleware does."""

import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from shared_control_ros.processes import node_environment

from shared_control_bringup.neighbours import SUSPECTS

from .finding import Finding, Level


def variables() -> Iterator[Finding]:
    """What is set, what nodes are not given of it, and what stands in the way."""
    # LD_LIBRARY_PATH leads to the wheels of ROS in this environment as soon as its Python has started.
    set_here = {name: value for name, value in sorted(os.environ.items())
                if name.startswith(SUSPECTS) and not (name == 'LD_LIBRARY_PATH' and sys.prefix in value)}
    shown = '; '.join(f'{name}={value}' for name, value in set_here.items())
    yield Finding(Level.OK, 'variables', shown or 'none that matters to ROS is set')
    given = node_environment()
    for name, value in set_here.items():
        if given.get(name) != value:
            yield Finding(Level.NOTE, name, 'kept from the nodes of a session; `ros2` commands in this shell go by it, '
                          'and may not find them', f'unset {name}, or use a shell that has not sourced another ROS')
    for name, why in _wrong(given):
        yield Finding(Level.FAULT, name, f'{given[name]!r}: {why}', f'unset {name}')
    if given.get('ROS_AUTOMATIC_DISCOVERY_RANGE') == 'SUBNET':
        yield Finding(Level.NOTE, 'ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET: whoever is on the network may command the '
                      'robot', 'unset ROS_AUTOMATIC_DISCOVERY_RANGE, unless the graph spans machines: '
                      'docs/how_to/security.md')


def _wrong(given: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Name of a variable of nodes, and why they do not start or do not find each other with it."""
    if given.get('ROS_AUTOMATIC_DISCOVERY_RANGE') == 'OFF':
        yield 'ROS_AUTOMATIC_DISCOVERY_RANGE', 'nodes do not find each other'
    profile = given.get('FASTRTPS_DEFAULT_PROFILES_FILE')
    if profile and not Path(profile).is_file():
        yield 'FASTRTPS_DEFAULT_PROFILES_FILE', 'there is no such file'
    keystore = given.get('ROS_SECURITY_KEYSTORE', '')
    if given.get('ROS_SECURITY_ENABLE') == 'true' and not Path(keystore).is_dir():
        yield 'ROS_SECURITY_ENABLE', f'there is no keystore {keystore!r} (ROS_SECURITY_KEYSTORE)'
