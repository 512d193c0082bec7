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

"""How a node tells the process that started it how far it is: lines through an inherited pipe."""

import os
from contextlib import suppress

READY_FD = 'SHARED_CONTROL_READY_FD'
"""Environment variable: number of the file descriptor to write to. Who starts a node alone need not set it."""
READY = b'ready\n'
DONE = b'done\n'
"""By itself, with nothing left to do but to take leave of the middleware."""


class ReadyPipe:
    """The pipe to whoever started this process, if there is one; it ends with the process."""

    def __init__(self) -> None:
        self._number = -1
        with suppress(OSError, ValueError):  # somebody may have handed on the variable without the pipe
            number = int(os.environ.pop(READY_FD, ''))  # not for the processes that this one may start
            os.set_inheritable(number, False)
            self._number = number

    def tell(self, line: bytes) -> None:
        """Write ``READY`` or ``DONE``."""
        with suppress(OSError):  # whoever waited may be gone
            os.write(self._number, line)
