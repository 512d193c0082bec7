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

"""Log lines that must not run across the screen."""

import os
import sys
import tempfile


class HeldBackOutput:
    """Keeps what this process writes to a terminal on stdout and stderr, and says it when the screen is gone.

    Works on file descriptors, because the ROS log is written by C. Output that goes to a file or a pipe is left alone.
    """

    def __init__(self) -> None:
        self._saved: dict[int, int] = {}
        self._kept = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the screen

    def hold(self) -> None:
        """Keep back from now on."""
        for stream, fd in ((sys.stdout, 1), (sys.stderr, 2)):
            if fd not in self._saved and os.isatty(fd):
                stream.flush()
                self._saved[fd] = os.dup(fd)
                os.dup2(self._kept.fileno(), fd)

    def release(self) -> None:
        """Write out what was kept and let the rest through."""
        for stream, fd in ((sys.stdout, 1), (sys.stderr, 2)):
            if fd in self._saved:
                stream.flush()
                saved = self._saved.pop(fd)
                os.dup2(saved, fd)
                os.close(saved)
        self._kept.seek(0)
        text = self._kept.read()
        self._kept.seek(0)
        self._kept.truncate()
        try:
            while text:
                text = text[os.write(2, text):]
        except OSError:
            pass  # the terminal is gone: nobody is left to read it
