"""What every test run of this repository begins with; pytest loads it by the entry point ``shared_control``."""

import signal


def pytest_configure() -> None:
    """Let the processes that tests start react to Ctrl-C and to a hang-up as they do in a terminal.

    A shell ignores SIGINT for what it runs in the background, and ``nohup`` SIGHUP; children inherit that.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
