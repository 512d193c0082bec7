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

"""The terminal after a session: as it was before, also where the node that drew on it was killed."""

import os
import signal
import termios
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from teleop_key_node.terminal import LEAVE


@contextmanager
def restored_terminal(path: str = '/dev/tty') -> Iterator[None]:
    """Put the terminal back as it was, if nobody else has; nothing where there is none.

    A node that is started in place of a killed one takes what that has left for how the terminal was.
    """
    try:
        terminal = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        before = termios.tcgetattr(terminal)
    except (OSError, termios.error):
        yield
        return
    try:
        yield
    finally:
        ttou = signal.signal(signal.SIGTTOU, signal.SIG_IGN)  # from the background, it would stop this process
        with suppress(OSError, termios.error):  # the terminal may be gone
            if termios.tcgetattr(terminal) != before:
                termios.tcsetattr(terminal, termios.TCSANOW, before)
                os.write(terminal, LEAVE)
        signal.signal(signal.SIGTTOU, ttou)
        os.close(terminal)
