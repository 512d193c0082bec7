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

"""The emergency stop on disk: a controller that died and was started again finds it there."""

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from shared_control.files import state_folder, write_atomically
from shared_control.processes import starter

PLACES = ('/tmp', '/dev/shm')
"""Where it is kept if there is no home to write to. Not where TMPDIR says: a controller that is started again from
another shell would look elsewhere. A container may have a memory to write to and no disk."""


class StopRecord:
    """Says whether the emergency stop of a graph is on, across the death of its controller.

    It is kept in ``$ROS_HOME`` (``~/.ros``), or in one of ``PLACES`` where that cannot be written, until it is
    forgotten. Only a controller that left cleanly and is then started by somebody else begins without it: a
    supervisor that starts it again, whatever ended it, is the same one as before.

    Args:
        domain: the ROS domain.
        namespace: of the controller.
    """

    def __init__(self, domain: int, namespace: str):
        self._name = f'emergency_stop_domain_{domain}{namespace.rstrip("/").replace("/", "__")}.json'

    def is_on(self) -> bool:
        """Whether a stop holds that was kept before this process."""
        return any(not content['left'] or content['starter'] == starter() for _, content in self._kept())

    def keep(self) -> None:
        """The emergency stop is on.

        Raises:
            OSError: it cannot be written anywhere.
        """
        self._write(left=False)

    def leave(self) -> None:
        """This controller leaves cleanly; a stop that is on is kept for whoever has started it."""
        for path, _ in self._kept():
            with suppress(OSError):
                _write(path, left=True)

    def forget(self) -> None:
        """The emergency stop is over."""
        for path, _ in self._kept():
            with suppress(OSError):
                path.unlink()

    def _write(self, left: bool) -> None:
        problem = OSError('no folder')
        for folder in _folders():
            try:
                folder.mkdir(parents=True, exist_ok=True)
                _write(folder / self._name, left)
            except OSError as error:
                problem = error
            else:
                return
        raise problem

    def _kept(self) -> Iterator[tuple[Path, dict[str, str | bool]]]:
        # What may not be entered holds no record: the unreadable one that means a stop is a file.
        for path in [folder / self._name for folder in _folders() if os.access(folder, os.X_OK, effective_ids=True)]:
            with suppress(FileNotFoundError, NotADirectoryError):
                yield path, _read(path)


def _write(path: Path, left: bool) -> None:
    # Not synced: the control loop writes it, which must not wait for a disk, and it is to outlive the process alone.
    write_atomically(path, json.dumps({'left': left, 'starter': starter()}).encode(), synced=False)


def _read(path: Path) -> dict[str, str | bool]:
    """A record that cannot be read is one of a stop."""
    try:
        content = json.loads(path.read_bytes())
        return {'left': bool(content['left']), 'starter': str(content['starter'])}
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {'left': False, 'starter': ''}


def _folders() -> list[Path]:
    return [state_folder(), *(Path(place) / f'shared_control_{os.getuid()}' for place in PLACES)]
