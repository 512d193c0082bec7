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

"""``shared-control session`` as a process, for tests and for the fault campaign."""

import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from shared_control.processes import leave_with_the_parent
from shared_control_ros.processes import node_module

COMMAND = [sys.executable, '-m', 'shared_control', 'session']


class Session:
    """``shared-control session`` with ``arguments``, without a terminal."""

    def __init__(self, arguments: list[str], **popen: Any):
        options: dict[str, Any] = {
            'stdin': subprocess.DEVNULL, 'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT,
            'start_new_session': True, 'preexec_fn': leave_with_the_parent, **popen}
        self.process: subprocess.Popen[str] = subprocess.Popen([*COMMAND, *arguments], text=True, **options)

    def node(self, name: str) -> int:
        """The process id of the node ``name``; 0 while it does not run."""
        children = Path(f'/proc/{self.process.pid}/task/{self.process.pid}/children').read_text().split()
        for child in children:
            with suppress(FileNotFoundError, ProcessLookupError):  # it may have just ended
                if node_module(name) in Path(f'/proc/{child}/cmdline').read_text().split('\0'):
                    return int(child)
        return 0

    def output(self, timeout: float = 300.0) -> str:
        """Wait for its end, and return what it printed."""
        return self.process.communicate(timeout=timeout)[0]

    def close(self) -> None:
        """End it, if it has not ended, and print what it has said, which tells why it had not."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                said = self.process.communicate(timeout=60)[0]
            except subprocess.TimeoutExpired:
                self.process.kill()
                said = self.process.communicate()[0]
            print(said or '')
        if self.process.stdout:
            self.process.stdout.close()
