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

import json
import logging
from collections.abc import Collection, Sequence
from contextlib import suppress
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
        own: the files that a run writes, in the folder or in one within it; ``*`` stands for any part of a name.
        mark: the JSON file that tells that there is a run.
        keys: that a run's mark has; a file of somebody else may have the same name.
    """

    def __init__(self, path: Path, kind: str, own: Sequence[str], mark: str, keys: Collection[str]):
        self.path = path
        self._kind = kind
        self._own = [*(name for name in own if name != mark), mark]  # it goes last: half-cleared is still a run
        self._mark, self._keys = path / mark, keys
        self._lock_path = path / '.lock'
        self._lock: IO[bytes] | None = None

    @property
    def holds_run(self) -> bool:
        """Whether there is a run."""
        try:
            content = json.loads(self._mark.read_text(encoding='utf-8'))
        except (OSError, ValueError, RecursionError):
            return False
        return isinstance(content, dict) and all(key in content for key in self._keys)

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

    def discard(self) -> None:
        """Remove what a run has written, and the folder when nothing else is in it: a run that came to nothing."""
        self._clear()
        self._lock_path.unlink(missing_ok=True)
        self.release()
        with suppress(OSError):  # somebody else's files are there
            self.path.rmdir()

    def _check(self, overwrite: bool) -> None:
        """Refuse a folder that may not be written anew."""
        if self.holds_run:
            if not overwrite:
                raise RunFolderError(
                    f'{self.path} already holds a {self._kind}: choose another folder, or overwrite it')
        elif self.path.exists() and any(child != self._lock_path for child in self.path.iterdir()):
            raise RunFolderError(f'{self.path} is not empty and no {self._kind}: choose another folder')

    def _clear(self) -> None:
        """Remove what a run has written; folders within stay where somebody else's files are in them."""
        folders = [self.path / folder for folder in sorted({str(Path(name).parent) for name in self._own} - {'.'})]
        for folder in folders:
            if folder.is_symlink():
                folder.unlink()
        for name in self._own:
            found = self.path.glob(name) if '*' in name else [self.path / name]
            for file in found:
                if file.is_symlink() or file.is_file():
                    file.unlink()
        for folder in folders:
            with suppress(OSError):  # not empty, or not there
                folder.rmdir()

    def _cannot_write(self, error: OSError) -> RunFolderError:
        return RunFolderError(f'cannot write the {self._kind} folder {self.path}: {error.strerror}')
