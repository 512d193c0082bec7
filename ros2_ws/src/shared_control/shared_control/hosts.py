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

"""The host of a server, as it is named to sockets and to browsers."""

import socket
from urllib.parse import urlsplit

LOOPBACK = ('127.0.0.1', 'localhost', '::1')
"""Names of this machine, by which it is reached from nowhere else."""
OWN_FRAMES_ONLY = {'Content-Security-Policy': "frame-ancestors 'self'", 'X-Frame-Options': 'SAMEORIGIN'}
"""Headers of an answer that a page of somebody else must not show within its own, where a person would press keys and
buttons of ours that they do not see."""


def is_loopback(authority: str) -> bool:
    """Whether a ``Host`` header, which anybody may have written, is a name of this machine, with or without a port."""
    try:
        return urlsplit(f'//{authority}').hostname in LOOPBACK
    except ValueError:
        return False


def family_of(host: str) -> socket.AddressFamily:
    """The address family of a socket that listens on ``host``."""
    return socket.AF_INET6 if ':' in host else socket.AF_INET


def url_of(host: str, port: int) -> str:
    """What a browser opens."""
    name = f'[{host}]' if ':' in host else host
    return f'http://{name}:{port}/'
