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

"""A terminal for tests: the test is at its keys and reads its screen."""

import os
import pty
import termios
import threading
from typing import Any


class Terminal:
    """A terminal of 80 x 24. Hand :meth:`popen_options` to ``subprocess.Popen``, then call :meth:`watch`."""

    def __init__(self) -> None:
        self._master, self._slave = pty.openpty()
        self.resize(24, 80)
        self._reader = threading.Thread(target=self._read)
        self.shown = ''
        """All that was shown so far, control sequences included."""

    def popen_options(self) -> dict[str, Any]:
        """Give a process this terminal as its own."""
        slave = self._slave
        return {'stdin': slave, 'stdout': slave, 'stderr': slave, 'start_new_session': False,
                'preexec_fn': lambda: os.login_tty(slave)}

    def watch(self) -> None:
        """Leave the terminal to the process that was started, and read along."""
        os.close(self._slave)
        self._reader.start()

    def _read(self) -> None:
        try:
            while data := os.read(self._master, 65536):
                self.shown += data.decode(errors='replace')
        except OSError:
            pass  # the last process has left the terminal

    @property
    def modes(self) -> list[Any]:
        """As of :func:`termios.tcgetattr`."""
        return termios.tcgetattr(self._master)

    def resize(self, rows: int, columns: int) -> None:
        """Change its size; the process is told."""
        termios.tcsetwinsize(self._master, (rows, columns))

    def type(self, keys: bytes) -> None:
        """Press keys."""
        os.write(self._master, keys)

    def close(self) -> None:
        """When the process has ended."""
        self._reader.join(5.0)
        os.close(self._master)
