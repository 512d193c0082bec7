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

"""Where the page is, and the token that lets people in. Light: who starts the node takes the address from here."""

import base64
import hashlib
import hmac
import os
import secrets
import socket

from shared_control.files import state_folder
from shared_control.hosts import LOOPBACK, family_of, url_of
from shared_control.processes import starter

TOKEN_VARIABLE = 'SHARED_CONTROL_PAGE_TOKEN'
"""Environment variable with the token, for who starts the node and tells the address: parameters are recorded."""


def needs_token(host: str) -> bool:
    """Whether a page that listens on ``host`` is open to the network."""
    return host not in LOOPBACK


def own_token(port: int) -> str:
    """A token for the page at a port: the same when whoever has started this process starts it again.

    An address that was opened stays good when the node died and was started anew. It is derived from a secret of this
    user's, in the folder of ROS; where there can be none, it is made anew at every start.
    """
    try:
        secret = _secret()
    except OSError:
        return secrets.token_urlsafe(16)
    digest = hmac.digest(secret, f'{starter()} {port}'.encode(), hashlib.sha256)
    return base64.urlsafe_b64encode(digest[:16]).decode().rstrip('=')


def _secret() -> bytes:
    path = state_folder() / 'page_secret'
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), 'wb') as file:
            file.write(secrets.token_bytes(32))
    except FileExistsError:
        pass
    secret = path.read_bytes()
    if len(secret) != 32:  # another node is writing it, or the disk was full
        raise OSError(f'{path} is no secret')
    return secret


def listen(host: str, port: int) -> socket.socket:
    """A socket at which the page can be served.

    Raises:
        OSError: the address cannot be had; the message names it.
    """
    try:
        return socket.create_server((host, port), family=family_of(host))
    except OSError as error:
        raise OSError(f'cannot serve the page at {host}:{port} ({error.strerror}): name another host or port, '
                      'port 0 for any that is free') from error


def free_port(host: str, port: int = 0) -> int:
    """A port of ``host`` at which nobody listens: this one, or any when it is 0.

    Raises:
        OSError: see :func:`listen`.
    """
    with listen(host, port) as bound:
        return bound.getsockname()[1]


def page_address(host: str, port: int, token: str | None) -> str:
    """What to open in a browser.

    Args:
        host: on which the page listens; when that is all interfaces, the name of this machine is in the address.
        port: on which it listens.
        token: None when the page is for this machine only.
    """
    if host in ('0.0.0.0', '::'):
        host = socket.gethostname()
    return url_of(host, port) + (f'?token={token}' if token else '')
