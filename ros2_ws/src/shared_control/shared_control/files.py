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

"""Where nodes keep what outlives them; files written as a whole, and by one process at a time."""

import errno
import fcntl
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import IO

_CANNOT_LOCK = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP, errno.EINVAL)
"""What ``flock`` gives on file systems that have none (some Lustre and NFS mounts)."""


def state_folder() -> Path:
    """The folder for what outlives a node, in ``$ROS_HOME`` (``~/.ros``); it may not exist, nor be writable."""
    return Path(os.environ.get('ROS_HOME') or os.path.expanduser('~/.ros')) / 'shared_control'


def write_atomically(path: Path, content: bytes, synced: bool = True) -> None:
    """Write ``content`` to ``path`` as a whole or not at all, whenever the process or the machine stops.

    A device or a pipe is written to. ``synced=False`` does not wait for the disk, and so holds for the process alone.

    Raises:
        OSError: it cannot be written; the error has ``path``.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        path.write_bytes(content)
        return
    try:
        _replace(path, content, synced)
    except OSError as error:
        error.filename, error.filename2 = str(path), None  # a full disk names none
        raise


def _replace(path: Path, content: bytes, synced: bool) -> None:
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f'.{path.name}.')
    temporary = Path(name)
    try:
        with os.fdopen(handle, 'wb') as file:
            file.write(content)
            file.flush()
            if synced:
                os.fsync(file.fileno())
        with suppress(PermissionError):  # FAT and some network file systems have no modes
            temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def refuse_unwritable(folder: Path) -> None:
    """Refuse, before work begins, a folder that cannot be written when it is done; it need not exist yet.

    Raises:
        NotADirectoryError: it, or what it is to be in, is a file.
        PermissionError: this user may not write there.
    """
    there = folder.absolute()
    while not there.exists() and not there.is_symlink():
        there = there.parent
    if not there.is_dir():
        raise NotADirectoryError(f'cannot write to {folder}: {there} is no folder')
    if not os.access(there, os.W_OK | os.X_OK):
        raise PermissionError(f'cannot write to {folder}: this user may not write to {there}')


def refuse_another_file(path: Path, kind: str, beginning: bytes) -> None:
    """Refuse to write ``path`` over a file that is not of the kind that is to be written, or where nobody may write.

    Args:
        path: where something is to be written; nothing need be there.
        kind: what is written, for the message: ``Parquet file``.
        beginning: the bytes that all such files begin with.

    Raises:
        FileExistsError: there is something else, and it is not empty; the message names it.
        OSError: it cannot be read, or its folder cannot be written.
    """
    if path.is_char_device():
        return
    refuse_unwritable(path.parent)
    if not path.exists():
        return
    is_own = path.is_file()
    if is_own:
        with path.open('rb') as file:
            is_own = file.read(len(beginning)) in (beginning, b'')
    if not is_own:
        raise FileExistsError(f'{path} exists already and is no {kind}: name another file')


def lock(file: IO[bytes]) -> bool:
    """Claim an open file for this process until it is closed or the process ends, however it ends.

    Returns:
        False when its file system has no locks: nobody is kept from it then.

    Raises:
        BlockingIOError: another process has claimed it.
        OSError: it cannot be claimed for another reason.
    """
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _CANNOT_LOCK:
            return False
        raise
    return True
