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

"""The controlling terminal: raw keys in, full screens out, and everything as it was afterwards."""

import atexit
import os
import select
import signal
import termios
import time
from types import FrameType

from .held_back_output import HeldBackOutput

# Alternate screen, cursor hidden, no wrapping at the right margin; and back.
_ENTER = b'\x1b[?1049h\x1b[?25l\x1b[?7l\x1b[2J'
LEAVE = b'\x1b[?2026l\x1b[0m\x1b[?7h\x1b[?25h\x1b[?1049l'
# Terminals that know synchronized output (DEC mode 2026) show a frame at once; the others ignore it.
_BEGIN_FRAME, _END_FRAME = '\x1b[?2026h', '\x1b[?2026l'
_REPAINT_AFTER = 2.0
"""Every line is written again after this, s, in case something else wrote across the screen."""
_USUAL_SIZE = 80, 24
"""Columns and rows of a terminal that does not tell them."""
_FLUSH_TIMEOUT = 0.2
"""How long leaving waits for a stalled terminal, s."""


class NoTerminal(Exception):
    """There is no terminal to draw on; the message says why."""


class Terminal:
    """Reads keys from, and draws on, the controlling terminal while this process is in its foreground.

    Reading and writing never wait: a stalled connection loses frames, not control ticks. Ctrl-C still interrupts and
    Ctrl-Z still suspends. The terminal's modes are restored by :meth:`leave`, which also runs at exit.

    Raises:
        NoTerminal: the process has no controlling terminal, or one that cannot draw.
    """

    def __init__(self, path: str = '/dev/tty'):
        if os.environ.get('TERM', 'dumb') in ('', 'dumb'):
            raise NoTerminal(f'TERM is {os.environ.get("TERM", "")!r}, which cannot draw')
        try:
            self._fd = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        except OSError as error:
            raise NoTerminal(f'{path}: {error.strerror}') from error
        self._original: list | None = None
        self._size = (0, 0)
        self._shown: list[str] = []
        self._repaint_at = 0.0
        self._pending = b''
        self._output = HeldBackOutput()
        self.is_gone = False
        """Whether the terminal hung up."""
        self.suspend_requested = False
        """Whether Ctrl-Z was pressed (SIGTSTP): call :meth:`suspend`."""
        self._continued = False
        signal.signal(signal.SIGTSTP, self._on_suspend)
        signal.signal(signal.SIGCONT, self._on_continue)
        atexit.register(self.leave)

    @property
    def is_entered(self) -> bool:
        """Whether the screen is up."""
        return self._original is not None

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows; asked anew each time, so that a resize is seen at the next frame."""
        try:
            columns, rows = os.get_terminal_size(self._fd)
        except OSError:
            columns = rows = 0
        # Serial lines and containers do not know their size, and say 0.
        return columns or _USUAL_SIZE[0], rows or _USUAL_SIZE[1]

    def _is_foreground(self) -> bool:
        try:
            return os.tcgetpgrp(self._fd) == os.getpgrp()
        except OSError:
            self.is_gone = True
            return False

    def read(self) -> bytes:
        """What was typed since the last call. Enters the screen when the process comes to the foreground."""
        if not self._is_foreground():
            self._forget()
            return b''
        if not self.is_entered or self._continued:
            self._enter()
        try:
            data = os.read(self._fd, 1024)
        except BlockingIOError:
            return b''
        except OSError:
            data = b''
        if not data:
            self.is_gone = True
        return data

    def paint(self, lines: list[str]) -> None:
        """Show ``lines`` from the top of the screen; the first is the title, in reverse video.

        Writes only what has changed, and nothing while the terminal has not taken the last frame.
        """
        if not self.is_entered or not self._flush():
            return
        now = time.monotonic()
        size = self.size
        clear = ''
        if size != self._size or len(lines) < len(self._shown):
            self._size, self._shown, clear = size, [], '\x1b[2J'
        elif now >= self._repaint_at:
            self._shown = []
        if not self._shown:
            self._repaint_at = now + _REPAINT_AFTER
        changes = []
        for row, line in enumerate(lines):
            if row >= len(self._shown) or line != self._shown[row]:
                style = ('\x1b[7m', '\x1b[0m') if row == 0 else ('', '')
                changes.append(f'\x1b[{row + 1};1H{style[0]}{line}{style[1]}')
        self._shown = lines
        if changes:
            self._pending = (_BEGIN_FRAME + clear + ''.join(changes) + _END_FRAME).encode(errors='replace')
            self._flush()

    def redraw(self) -> None:
        """Paint everything at the next frame."""
        self._size = (0, 0)

    def _flush(self) -> bool:
        """Write what waits, as far as the terminal takes it; whether nothing is left."""
        try:
            while self._pending:
                self._pending = self._pending[os.write(self._fd, self._pending):]
        except BlockingIOError:
            return False
        except OSError:
            self.is_gone = True
            self._pending = b''
        return True

    def _enter(self) -> None:
        self._continued = False
        if self._original is None:
            self._original = termios.tcgetattr(self._fd)
        modes = list(self._original)
        modes[0] &= ~termios.IXON  # Ctrl-S would freeze the screen
        modes[3] &= ~(termios.ICANON | termios.ECHO)
        modes[6] = list(modes[6])
        modes[6][termios.VMIN], modes[6][termios.VTIME] = 1, 0
        modes[6][termios.VQUIT] = bytes([os.fpathconf(self._fd, 'PC_VDISABLE')])  # it would kill without restoring
        termios.tcsetattr(self._fd, termios.TCSANOW, modes)
        self._output.hold()
        self.redraw()
        self._pending = _ENTER
        self._flush()

    def _forget(self) -> None:
        """The shell has taken the terminal back, with its own modes: let it be."""
        if self.is_entered:
            self._original = None
            self._output.release()

    def leave(self, restore_modes: bool = True) -> None:
        """Put the terminal back as it was. Safe to call again, and when the terminal is gone.

        Args:
            restore_modes: False when the shell has given it its own already, and keeps them.
        """
        if self._original is None:
            return
        original, self._original = self._original, None
        deadline = time.monotonic() + _FLUSH_TIMEOUT
        # From the background, restoring would stop this process instead.
        ttou = signal.signal(signal.SIGTTOU, signal.SIG_IGN)
        try:
            self._pending += f'\x1b[{self.size[1]};1H'.encode() + LEAVE
            while not self._flush() and time.monotonic() < deadline:
                select.select([], [self._fd], [], 0.02)
            if restore_modes:
                termios.tcflush(self._fd, termios.TCIFLUSH)
                termios.tcsetattr(self._fd, termios.TCSANOW, original)
        except (OSError, termios.error):
            self.is_gone = True
        finally:
            signal.signal(signal.SIGTTOU, ttou)
            self._output.release()

    def _on_suspend(self, _signal: int, _frame: FrameType | None) -> None:
        self.suspend_requested = True

    def _on_continue(self, _signal: int, _frame: FrameType | None) -> None:
        self._continued = True  # the shell may have changed the modes meanwhile

    def suspend(self) -> None:
        """Give the terminal back to the shell and stop until SIGCONT; the next read enters again."""
        self.suspend_requested = False
        self.leave(restore_modes=self._is_foreground())
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, self._on_suspend)

    def close(self) -> None:
        """Leave for good."""
        self.leave()
        atexit.unregister(self.leave)
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        signal.signal(signal.SIGCONT, signal.SIG_DFL)
        os.close(self._fd)
