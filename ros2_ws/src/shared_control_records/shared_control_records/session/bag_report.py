"""The report of a session, from nothing but its bag."""

from pathlib import Path

from ..bag.reader import read_bag
from .bag_metadata import unpack
from .folder import SessionFolder
from .report import write_report


def write_bag_report(bag: Path, output: Path) -> Path:
    """Draw the session's report again into a new folder ``output``; gives the page.

    Raises:
        OSError: the bag cannot be read, or the folder exists already or cannot be written; the message names it.
    """
    content = read_bag(bag)
    folder = SessionFolder.create(output)
    folder.bag = bag.absolute()
    try:
        unpack(content, folder)
        write_report(folder, bag=content)
    finally:
        folder.release()
    return folder.report
