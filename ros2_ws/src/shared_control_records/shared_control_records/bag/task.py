"""Which task a bag was recorded of."""

import json
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader
from shared_control.plugins import TASKS, load
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task

from .files import BagReadError

SETTINGS = 'settings.json'
"""Name of the file with a session's settings, beside its bag and in the bag's record."""
RECORD = 'shared_control_session'
"""Name of the metadata record that a session puts into its bag; its keys are paths within the session's folder, its
values the files' text."""


def recorded_task(bag: Path) -> Task:
    """The task of a session's bag, a rosbag2 folder or a single MCAP file; ``balance`` when nothing names another.

    Raises:
        ValueError: there is no task of that name; the message lists the names.
    """
    beside = bag.absolute().parent / SETTINGS
    if beside.is_file() and not bag.is_file():
        text = beside.read_text()
    else:
        text = session_record(bag).get(SETTINGS, '{}') if bag.exists() else '{}'
    try:
        name = json.loads(text).get('task')
    except (ValueError, AttributeError):
        name = None
    task: Task = load(TASKS, name)() if isinstance(name, str) and name else BALANCE
    return task


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
