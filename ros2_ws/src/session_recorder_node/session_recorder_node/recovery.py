"""Making a bag whole again whose recorder was killed."""

from dataclasses import dataclass
from pathlib import Path

from .bag_folder import BagError, bag_files
from .mcap_repair import finish
from .metadata import lists_all_files, read_summary, write_metadata


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


def recover(bag: str | Path) -> list[Recovered]:
    """Finish the files that a killed recorder left unfinished, and bring the bag's ``metadata.yaml`` up to date.

    Every chunk that had reached the file is kept. It is safe to call at any time, and does nothing to a whole bag.

    Returns:
        What was finished; nothing for a bag that is whole.

    Raises:
        BagError: there is no such folder, a recorder is still writing it, or a file in it is no recording.
        OSError: the folder cannot be written.
    """
    bag = Path(bag).expanduser().absolute()
    if not bag.is_dir():
        raise BagError(f'there is no bag at {bag}')
    unfinished = [path for path in bag_files(bag) if read_summary(path) is None]
    recovered = [Recovered(path, *finish(path)) for path in unfinished]
    if bag_files(bag) and (recovered or not lists_all_files(bag)):
        write_metadata(bag)
    return recovered


def annotate(bag: str | Path, name: str, content: dict[str, str]) -> None:
    """Put a metadata record into the last file of a finished bag, in place of an earlier one.

    Raises:
        BagError: the bag has no file, or a recorder is still writing it.
        OSError: the file cannot be written; :func:`recover` finishes it when there is room again.
    """
    files = bag_files(Path(bag))
    if not files:
        raise BagError(f'there is no bag at {bag}')
    finish(files[-1], (name, content))
