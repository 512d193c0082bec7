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

"""What Ctrl-Z does to a session in a terminal."""

import os
import signal
import subprocess
import sys

SESSION = """
import sys
from shared_control_bringup.suspension import Suspension

class Node:
    looks = 0

    def exit_code(self):
        return None

    def held_by(self):
        self.looks += 1
        return 'Ctrl-Z' if self.looks == 3 else ''

node = Node()
with Suspension(node) as suspension:
    print('begun', flush=True)
    sys.stdin.readline()
    suspension.poll()
    print(node.looks)
    suspension.poll()
print('over')
"""


def test_the_session_stops_after_the_node_in_the_terminal_and_goes_on():
    session = subprocess.Popen([sys.executable, '-c', SESSION], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               text=True, process_group=0)
    assert session.stdout is not None and session.stdin is not None
    assert session.stdout.readline() == 'begun\n'
    session.send_signal(signal.SIGTSTP)
    session.stdin.write('\n')
    session.stdin.flush()
    _, status = os.waitpid(session.pid, os.WUNTRACED)
    assert os.WIFSTOPPED(status) and os.WSTOPSIG(status) == signal.SIGTSTP
    session.send_signal(signal.SIGCONT)
    assert session.communicate(timeout=60)[0] == '3\nover\n'
    assert session.returncode == 0
