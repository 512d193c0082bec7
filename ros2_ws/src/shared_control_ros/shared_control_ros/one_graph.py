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

"""One robot, controller, teleoperation and learner in a ROS domain and namespace: two would disturb every tick."""

import errno
import socket
import struct
from hashlib import sha256
from pathlib import Path

from rclpy.node import Node
from shared_control.printable import cut, escaped

from .parameters import ParameterError

_CREDENTIALS = struct.Struct('3i')
"""Process, user and group at the other end of a socket (unix(7), SO_PEERCRED)."""


def claim(node: Node, role: str) -> socket.socket:
    """Claim a role of the graph for a node, until the socket is closed or the process ends.

    A role is the name of a socket, not a file: names are the kernel's, one list for all that share a network, as those
    do that hear each other on this machine. A file's place depends on the shell (TMPDIR) and on the container; it may
    be another user's, on a read-only disk, or cleaned away under a node that runs. Nothing is left of a node that was
    killed.

    Args:
        node: that has the role.
        role: ``robot``, ``controller``, ``teleoperation`` or ``learner``.

    Returns:
        The socket, to be kept open.

    Raises:
        ParameterError: another process has the role, which the message names.
    """
    domain, namespace = node.context.get_domain_id(), node.get_namespace()
    # The leading zero makes it a name without a file; a namespace may be longer than such a name.
    name = b'\0shared_control_' + sha256(f'{role} {domain} {namespace}'.encode()).hexdigest().encode()
    claimed = socket.socket(socket.AF_UNIX)
    try:
        claimed.bind(name)
        claimed.listen()  # for _holder
    except OSError as error:
        claimed.close()
        if error.errno != errno.EADDRINUSE:
            raise
        raise ParameterError(
            f'{_holder(name)} is the {role} in ROS domain {domain}, namespace {namespace} already: end it, or set '
            'ROS_DOMAIN_ID to another number') from None
    return claimed


def _holder(name: bytes) -> str:
    """Which process has the name, as far as that is to be seen from here."""
    with socket.socket(socket.AF_UNIX) as asking:
        asking.setblocking(False)  # nobody accepts: many who ask would fill the queue
        try:
            asking.connect(name)
            process, _, _ = _CREDENTIALS.unpack(
                asking.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size))
            command = Path(f'/proc/{process}/cmdline').read_bytes()
        except OSError:  # it is just beginning or ending, or in another container
            return 'another process'
    words = command.partition(b'--ros-args')[0].decode(errors='replace').split('\0')
    return escaped(f'process {process} ({cut(" ".join(Path(word).name for word in words).strip(), 80)})')
