"""Ctrl-C, SIGTERM and SIGHUP of a session: noted when they come, acted upon where nothing is lost by it."""

import signal
from types import FrameType
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupts:
    """While it is entered, none of the signals ends this process, however many of them come."""

    def __init__(self) -> None:
        self.requested = False
        """Whether one has come."""
        self._previous: dict[int, Any] = {}

    def check(self) -> None:
        """Call where the work can stop.

        Raises:
            KeyboardInterrupt: a signal has come.
        """
        if self.requested:
            raise KeyboardInterrupt

    def __enter__(self) -> 'Interrupts':
        for number in SIGNALS:
            if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:  # nohup
                self._previous[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self.requested = True
