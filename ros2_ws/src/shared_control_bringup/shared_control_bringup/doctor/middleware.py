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

"""Checks of the middleware, by trying it as a session does before it starts its nodes."""

import os
from collections.abc import Iterator

from shared_control_bringup.neighbours import Neighbours

from .finding import Finding, Level


def middleware() -> Iterator[Finding]:
    """Whether ROS starts, two nodes find each other, and nobody is in the domain."""
    domain = os.environ.get('ROS_DOMAIN_ID', '').strip() or '0'
    try:
        with Neighbours() as neighbours:
            neighbours.refuse()
    except ValueError as problem:
        # The message names the remedy itself: a session refuses to start by the same words.
        yield Finding(Level.FAULT, f'ROS, domain {domain}', str(problem))
    else:
        yield Finding(Level.OK, f'ROS, domain {domain}', 'nodes find each other, and nobody else is there')
