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

"""One robot and one controller in a ROS domain and namespace: two would disturb each other's every tick."""

import os
import tempfile
from pathlib import Path
from typing import IO

from rclpy.node import Node
from shared_control.files import lock

from .parameters import ParameterError


def claim(node: Node, role: str) -> IO[bytes]:
    """Claim a role of the graph (``robot``, ``controller``) for a node, until the file is closed or the process ends.

    Other processes of this machine are meant; what is left of one that was killed is no hindrance.

    Returns:
        The file, to be kept open.

    Raises:
        ParameterError: another process has the role; the message names it.
    """
    domain, namespace = node.context.get_domain_id(), node.get_namespace()
    name = f'shared_control_{role}_domain_{domain}{namespace.rstrip("/").replace("/", "__")}.lock'
    path = Path(tempfile.gettempdir()) / name
    try:
        file: IO[bytes] = path.open('a+b')
    except PermissionError:  # another user has run one before
        file = path.open('rb')
    try:
        lock(file)
    except BlockingIOError:
        file.seek(0)
        other = file.read(200).decode(errors='replace') or 'another process'
        file.close()
        raise ParameterError(
            f'{other} is the {role} in ROS domain {domain}, namespace {namespace} already: end it, or set '
            'ROS_DOMAIN_ID to another number') from None
    if file.writable():
        file.truncate(0)
        file.write(f'{node.get_fully_qualified_name()} (process {os.getpid()})'.encode())
        file.flush()
    return file
