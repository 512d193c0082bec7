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

"""Making a bag whole again whose recorder was killed, and adding to a whole one."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .files import LIBRARY, BagError, bag_files
from .metadata import read_summary, recorder_of, unlisted_files, write_metadata
from .rewrite import rewrite


@dataclass(frozen=True)
class Recovered:
    """A file that was finished afterwards."""

    path: Path
    messages: int
    """How many it holds; a file without any was removed."""
    cut: int
    """Bytes of a torn end that were cut off."""

    def __str__(self) -> str:
        return f'{self.path}: {self.messages} messages kept, {self.cut} bytes of a torn end cut off'


def recover(bag: str | Path, meanwhile: Callable[[], None] = lambda: None, own_only: bool = False) -> list[Recovered]:
    """Finish the files that a killed recorder left unfinished, and bring the bag's ``metadata.yaml`` up to date.

    Every chunk that had reached the file is kept. It is safe to call at any time, and does nothing to a whole bag.

    Args:
        bag: the bag's folder.
        meanwhile: called after each chunk that was copied; a file has four a second of recording.
        own_only: leave files alone of which this project's recorder is not known to be the writer: another one's may
            still grow.

    Returns:
        What was finished; nothing for a bag that is whole.

    Raises:
        BagError: there is no such folder, a recorder is still writing it, or a file in it is no recording or damaged
            before its end.
        OSError: the folder cannot be written, or has no room for a second copy of a file.
    """
    bag = Path(bag).expanduser().absolute()
    if not bag.is_dir():
        raise BagError(f'there is no bag at {bag}')
    unfinished = [path for path in bag_files(bag) if read_summary(path) is None and (
        not own_only or recorder_of(path) == LIBRARY)]
    recovered = [Recovered(path, *rewrite(path, meanwhile=meanwhile)) for path in unfinished]
    if bag_files(bag) and (recovered or unlisted_files(bag)):
        write_metadata(bag)
    return recovered


def annotate(bag: str | Path, name: str, content: dict[str, str]) -> None:
    """Put a metadata record into the last file of a bag, in place of an earlier one of that name.

    What a killed recorder left unfinished is finished first. The file is copied, which takes a while for a long one.

    Raises:
        BagError: the bag has no file, or as in :func:`recover`.
        OSError: as in :func:`recover`; the file is as it was.
    """
    recover(bag)
    files = bag_files(Path(bag).expanduser())
    if not files:
        raise BagError(f'{bag} has no file NAME_NUMBER.mcap (compressed files, .mcap.zstd, are not written to)')
    rewrite(files[-1], (name, content))
