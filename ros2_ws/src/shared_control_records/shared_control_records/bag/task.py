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

"""Which task a bag was recorded of."""

import json
from itertools import islice
from pathlib import Path
from typing import Any

from mcap.exceptions import McapError
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from shared_control import contract
from shared_control.plugins import TASKS, load
from shared_control.tasks.task import Task

from .files import BagReadError

SETTINGS = 'settings.json'
"""Name of the file with a session's settings, beside its bag and in the bag's record."""
RECORD = 'shared_control_session'
"""Name of the metadata record that a session puts into its bag; its keys are paths within the session's folder, its
values the files' text."""


REPORTS_READ = 100
"""Reports of nodes in which their task is looked for: each says it once a second."""


def recorded_task(bag: Path) -> Task | None:
    """The task of a session's bag, a rosbag2 folder or a single MCAP file; None when nothing that was kept names it.

    Raises:
        ValueError: there is no task of that name; the message lists the names.
    """
    beside = bag.absolute().parent / SETTINGS
    if beside.is_file() and not bag.is_file():
        text = beside.read_text(encoding='utf-8')
    else:
        text = session_record(bag).get(SETTINGS, '{}') if bag.exists() else '{}'
    try:
        name = json.loads(text).get('task')
    except (ValueError, AttributeError, RecursionError):
        name = None
    return load(TASKS, name)() if isinstance(name, str) and name else None


def reported_task(reader: AnyReader) -> Task | None:
    """The task that simulator or controller reported on /diagnostics of an open bag; None when none did.

    Raises:
        ValueError: there is no task of that name; the message lists the names.
    """
    reports = [connection for connection in reader.connections
               if connection.topic.endswith(contract.DIAGNOSTICS.full_name)]
    for connection, _, raw in islice(reader.messages(reports), REPORTS_READ) if reports else ():
        try:
            message: Any = reader.deserialize(raw, connection.msgtype)
        except Exception:  # garbled: anybody can have published it, and rosbags raises errors of many kinds
            continue
        names = [value.value for status in message.status for value in status.values if value.key == 'task']
        if names:
            return load(TASKS, names[0])()
    return None


def session_record(bag: Path) -> dict[str, str]:
    """The session's record in the last file that has one; empty when none has.

    Raises:
        BagReadError: a file cannot be read.
    """
    found: dict[str, str] = {}
    for path in sorted(bag.glob('*.mcap'), key=lambda file: (len(file.name), file.name)) if bag.is_dir() else [bag]:
        try:
            with path.open('rb') as file:
                found = next((record.metadata for record in make_reader(file).iter_metadata()
                              if record.name == RECORD), found)
        except (McapError, OSError, ValueError) as error:
            raise BagReadError(f'cannot read {path}: {error or type(error).__name__}') from error
    return found
