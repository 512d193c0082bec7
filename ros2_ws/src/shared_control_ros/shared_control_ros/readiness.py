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
