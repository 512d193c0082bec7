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

"""Which files a bag folder holds, and who may write them."""

import os
import re
from pathlib import Path
from typing import IO

from mcap.writer import MCAP0_MAGIC
from shared_control import files

LIBRARY = 'session_recorder_node'
"""What the files of this project's recorder say has written them."""
_NUMBER = re.compile(r'_(\d+)\.mcap$')


class BagReadError(OSError):
    """A bag cannot be read; the message names it and says why."""


class BagError(OSError):
    """A bag cannot be written or read; the message names the file and the reason."""


def find_bag(path: Path) -> Path:
    """The bag that a person means by ``path``: itself, a rosbag2 folder or an MCAP file; or that in a session's folder.

    It may not exist.
    """
    is_session = (path / 'bag').is_dir() or (path / 'settings.json').is_file()
    return path / 'bag' if is_session and not any(path.glob('*.mcap')) else path


def check_is_bag(path: Path) -> None:
    """Refuse a path where no recorder has written, be it finished or not.

    Raises:
        BagReadError: nothing is there, or something else.
        OSError: it cannot be read.
    """
    meant = 'name a folder of a session or of ros2 bag, or an MCAP file'
    if not path.exists():
        raise BagReadError(f'there is no bag {path}: {meant}')
    if path.is_dir():
        is_bag = (path / 'metadata.yaml').is_file() or any(path.glob('*.mcap'))
    else:
        with path.open('rb') as file:
            is_bag = path.suffix == '.mcap' or file.read(len(MCAP0_MAGIC)) == MCAP0_MAGIC
    if not is_bag:
        raise BagReadError(f'{path} is no bag: {meant}')


def bag_files(bag: Path) -> list[Path]:
    """The ``<name>_<number>.mcap`` files of a bag in the order in which they were recorded.

    Those of other recorders, and renamed ones, may have no number: where none has, all count.
    """
    found = sorted(bag.glob('*.mcap'), key=lambda path: (_number(path), path.name))
    return [path for path in found if _NUMBER.search(path.name)] or found


def next_file(bag: Path) -> Path:
    """The file that a recorder starting now writes; it does not exist yet."""
    files = bag_files(bag)
    return bag / f'{bag.name}_{_number(files[-1]) + 1 if files else 0}.mcap'


def lock(file: IO[bytes], path: Path) -> None:
    """Claim a file for this process until it is closed or the process ends, however it ends.

    Raises:
        BagError: another process is writing the file, or has removed or replaced it.
    """
    try:
        files.lock(file)
    except BlockingIOError as error:
        raise BagError(f'{path} is being recorded by another process') from error
    if not os.fstat(file.fileno()).st_nlink:
        raise BagError(f'{path} was removed or replaced by another process')


def _number(path: Path) -> int:
    found = _NUMBER.search(path.name)
    return int(found[1]) if found else -1
