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

"""The report of a session, from nothing but its bag."""

from pathlib import Path

from shared_control.run_folder import RunFolderError

from ..bag.reader import read_bag
from .bag_metadata import unpack
from .folder import SessionFolder
from .report import write_report


def write_bag_report(bag: Path, output: Path) -> Path:
    """Draw the session's report again into a new folder ``output``; gives the page. On an error nothing is left there.

    Raises:
        ValueError: what the session kept in the bag is damaged; the message names the bag and the part.
        OSError: the bag cannot be read, or the folder exists already or cannot be written; the message names it.
    """
    content = read_bag(bag)
    folder = SessionFolder.create(output)
    folder.bag = bag.absolute()
    try:
        unpack(content, folder)
        write_report(folder, bag=content)
    except (ValueError, RunFolderError) as error:
        folder.discard()
        what = str(error).replace(f'{folder.path}/', '')
        raise ValueError(f'the record of the session in {bag} is damaged: {what}') from error
    except BaseException:  # an interrupt, too: half a report is in the way of the next
        folder.discard()
        raise
    folder.release()
    return folder.report
