"""Processes that do not outlive the one that started them."""

import ctypes
import signal


def leave_with_the_parent() -> None:
    """Have this process asked to leave (SIGTERM) when its parent dies, even by SIGKILL.

    For ``subprocess.Popen(preexec_fn=...)``; Linux only.
    """
    set_parent_death_signal = 1
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGTERM)
