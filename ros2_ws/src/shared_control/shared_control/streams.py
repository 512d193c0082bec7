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

"""Standard streams that are closed (``>&-``), whose reader is gone (``| head``), or that say what nobody asked for."""

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO


def open_closed_streams() -> None:
    """Open standard streams that this process was started without on /dev/null.

    Files that are opened later would get their numbers, and what is printed.
    """
    for name, mode in (('stdin', 'r'), ('stdout', 'w'), ('stderr', 'w')):
        if getattr(sys, name) is None:
            number = os.open(os.devnull, os.O_RDWR)  # the lowest that is free: the stream's own
            os.set_inheritable(number, True)
            setattr(sys, name, os.fdopen(number, mode, encoding='utf-8', closefd=False))


_NO_READER = (errno.EPIPE, errno.EIO)
"""When the reader of a pipe, or of a terminal, is gone."""


class _Lossy:
    """A text stream that goes on as if nothing had happened when its reader is gone."""

    def __init__(self, stream: TextIO):
        self._stream = stream
        self.lost: OSError | None = None
        """Why something is missing that somebody waits for: a full disk."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        with self._without_reader():
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        with self._without_reader():
            self._stream.flush()

    @contextmanager
    def _without_reader(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            if error.errno not in _NO_READER and self.lost is None:
                self.lost = error
            # What is still in the buffer, and what child processes write, goes the same way.
            with suppress(OSError, ValueError):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, self._stream.fileno())
                os.close(nowhere)


@contextmanager
def lossy_output() -> Iterator[None]:
    """Let stdout and stderr lose what nobody reads, so that no work is lost with it.

    Raises:
        OSError: in the end, when something is missing that somebody would read: the disk was full.
    """
    streams = sys.stdout, sys.stderr
    lossy = [_Lossy(stream) for stream in streams]
    sys.stdout, sys.stderr = lossy  # type: ignore[assignment]
    try:
        yield
    finally:
        for stream in lossy:
            stream.flush()
        sys.stdout, sys.stderr = streams
    for stream, name in zip(lossy, ('output', 'error'), strict=True):
        if stream.lost is not None:
            raise OSError(f'standard {name} is not complete: {stream.lost.strerror}') from stream.lost


@contextmanager
def muted() -> Iterator[None]:
    """Drop what is written to the process's stderr meanwhile: the greetings of C libraries that are being imported."""
    try:
        saved = os.dup(2)
    except OSError:  # closed: there is nothing to mute
        yield
        return
    try:
        with open(os.devnull, 'wb') as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
