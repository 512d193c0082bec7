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

"""Processes and the one that started them."""

import ctypes
import os
import signal
from pathlib import Path


def leave_with_the_parent() -> None:
    """Have this process asked to leave (SIGTERM) when its parent dies, even by SIGKILL.

    For ``subprocess.Popen(preexec_fn=...)``; Linux only.
    """
    set_parent_death_signal = 1
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGTERM)


def begin_worker(parent: int) -> None:
    """Prepare a process that works for ``parent``, before it imports what takes seconds.

    It ends with the parent, leaves Ctrl-C to it, says nothing, and computes in one thread. For
    ``ProcessPoolExecutor(initializer=...)``.

    Raises:
        ProcessLookupError: the parent ended while this process began.
    """
    leave_with_the_parent()
    if os.getppid() != parent:
        raise ProcessLookupError('the parent ended while this process began')
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):  # libraries greet whoever imports them
        os.dup2(nowhere, stream)
    os.environ['OMP_NUM_THREADS'] = '1'


def starter() -> str:
    """The process that started this one, by number and time of its start, since numbers are used again.

    Whatever is started again by a supervisor, or by ROS' launch, finds the same.
    """
    parent = os.getppid()
    try:
        started = Path(f'/proc/{parent}/stat').read_text(encoding='utf-8').rpartition(')')[2].split()[19]
    except (OSError, IndexError):
        started = ''
    return f'{parent} {started}'
