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

"""The folder that a run writes: what in it is the run's own, and who may write there."""

import logging
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from .files import lock


class RunFolderError(OSError):
    """A run's folder cannot be used; the message names it and says why."""


class RunFolder:
    """A folder that one process at a time writes. What it does not know by name is somebody else's and stays.

    Args:
        path: of the folder; it may not exist.
        kind: what a run is called in messages: ``session``.
        own: names of the files and folders that a run writes.
        marks: those of ``own`` that tell that there is a run; any of them does.
    """

    def __init__(self, path: Path, kind: str, own: Sequence[str], marks: Sequence[str]):
        self.path = path
        self._kind = kind
        self._own = [*(name for name in own if name not in marks), *marks]  # marks go last: half-cleared is still a run
        self._marks = marks
        self._lock_path = path / '.lock'
        self._lock: IO[bytes] | None = None

    @property
    def holds_run(self) -> bool:
        """Whether there is a run."""
        return any((self.path / mark).exists() for mark in self._marks)

    def begin(self, overwrite: bool = False) -> None:
        """Make the folder, claim it, and remove what an earlier run wrote. Nothing is touched when it is refused.

        Args:
            overwrite: an earlier run may be removed.

        Raises:
            RunFolderError: it holds an earlier run or something else, cannot be written, or is in use.
        """
        try:
            if not self._lock_path.exists():
                self._check(overwrite)  # before a lock is left in a stranger's folder
                self.path.mkdir(parents=True, exist_ok=True)
            self.claim()
            self._check(overwrite)
            if self.holds_run:
                self._clear()
        except RunFolderError:
            self.release()
            raise
        except OSError as error:
            self.release()
            raise self._cannot_write(error) from error

    def claim(self) -> None:
        """Hold the folder until :meth:`release`, or until this process ends, however it ends.

        A file system without locks is told of in the log, and the folder is used all the same.

        Raises:
            RunFolderError: another process holds it, or it cannot be written.
        """
        try:
            file = self._lock_path.open('ab')
        except OSError as error:
            raise self._cannot_write(error) from error
        try:
            if not lock(file):
                logging.getLogger(__name__).warning(
                    '%s is on a file system without locks: see to it yourself that one %s at a time writes there',
                    self.path, self._kind)
        except BlockingIOError as error:
            file.close()
            raise RunFolderError(f'the {self._kind} folder {self.path} is in use by another {self._kind}: wait for its '
                                 'end, or choose another folder') from error
        except OSError as error:
            file.close()
            raise self._cannot_write(error) from error
        self._lock = file

    def release(self) -> None:
        """Let others have the folder."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def _check(self, overwrite: bool) -> None:
        """Refuse a folder that may not be written anew."""
        if self.holds_run:
            if not overwrite:
                raise RunFolderError(
                    f'{self.path} already holds a {self._kind}: choose another folder, or overwrite it')
        elif self.path.exists() and any(child != self._lock_path for child in self.path.iterdir()):
            raise RunFolderError(f'{self.path} is not empty and no {self._kind}: choose another folder')

    def _clear(self) -> None:
        for child in (self.path / name for name in self._own):
            if child.is_dir() and not child.is_symlink():
                shutil.rmtree(child)
            else:
                child.unlink(missing_ok=True)

    def _cannot_write(self, error: OSError) -> RunFolderError:
        return RunFolderError(f'cannot write the {self._kind} folder {self.path}: {error.strerror}')
