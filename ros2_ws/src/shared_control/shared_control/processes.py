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


def starter() -> str:
    """The process that started this one, by number and time of its start, since numbers are used again.

    Whatever is started again by a supervisor, or by ROS' launch, finds the same.
    """
    parent = os.getppid()
    try:
        started = Path(f'/proc/{parent}/stat').read_text().rpartition(')')[2].split()[19]
    except (OSError, IndexError):
        started = ''
    return f'{parent} {started}'
