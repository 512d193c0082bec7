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

"""Addresses on command lines."""

import argparse

HIGHEST_PORT = 65535


def host_and_port(text: str) -> tuple[str, int]:
    """``HOST:PORT``, for ``argparse``; port 0 is any that is free."""
    host, _, port = text.rpartition(':')
    if not host or not port.isdecimal():
        raise argparse.ArgumentTypeError(f'expected HOST:PORT, got {text!r}')
    if int(port) > HIGHEST_PORT:
        raise argparse.ArgumentTypeError(f'a port is at most {HIGHEST_PORT}, got {text!r}')
    return host.strip('[]'), int(port)
