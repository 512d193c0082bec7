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

"""How a node tells the process that started it that it is ready: a line through an inherited pipe."""

import os
from contextlib import suppress

READY_FD = 'SHARED_CONTROL_READY_FD'
"""Environment variable: number of the file descriptor to write to. Who starts a node alone need not set it."""


def tell_ready() -> None:
    """Write a line to the pipe and close it, if there is one."""
    number = os.environ.pop(READY_FD, '')  # not for the processes that this one may start
    # Whoever waited may be gone, or may have handed on the variable without the pipe.
    with suppress(OSError, ValueError), os.fdopen(int(number), 'w') as pipe:
        pipe.write('ready\n')
