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

"""One robot, controller and learner in a ROS domain and namespace: two would disturb each other's every tick."""

import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import IO

from rclpy.node import Node
from shared_control.files import lock

from .parameters import ParameterError


def claim(node: Node, role: str) -> IO[bytes]:
    """Claim a role of the graph for a node, until the file is closed or the process ends.

    Other processes of this machine are meant; what is left of one that was killed is no hindrance.

    Args:
        node: that has the role.
        role: ``robot``, ``controller`` or ``learner``.

    Returns:
        The file, to be kept open.

    Raises:
        ParameterError: another process has the role, which the message names, or the file is another user's.
    """
    domain, namespace = node.context.get_domain_id(), node.get_namespace()
    name = f'shared_control_{role}_domain_{domain}{namespace.rstrip("/").replace("/", "__")}.lock'
    path = Path(tempfile.gettempdir()) / name
    file = _open(path)
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


def _open(path: Path) -> IO[bytes]:
    """The file, to be read by every user, whatever the umask; to be written by the one whose it is."""
    try:
        file = os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644), 'r+b')
    except PermissionError:  # another user has run one before
        try:
            return path.open('rb')
        except PermissionError:
            raise ParameterError(f'{path} is of another user, and not to be read: have it removed, or set '
                                 'ROS_DOMAIN_ID to another number') from None
    with suppress(PermissionError):
        os.fchmod(file.fileno(), 0o644)
    return file
