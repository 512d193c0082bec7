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

"""What the experimenter says of a participant: ``notes.csv``, to which lines are added and in which none is changed."""

import csv
import io
import os
import re
import time
from pathlib import Path
from typing import NamedTuple

NAME = 'notes.csv'
"""In a participant's folder."""
KINDS = ('note', 'exclude', 'include')
_BEGINNING = re.compile(rf'[^,"]*,({"|".join(KINDS)}),')
"""How a note begins."""


class Note(NamedTuple):
    """A line of it."""

    at: str
    """When, ISO 8601."""
    kind: str
    """One of ``KINDS``."""
    text: str
    """What was noted, or why the participant is left out of the report."""


def add_note(person: Path, kind: str, text: str) -> None:
    """Add a line; also while the participant is being led through the study.

    Args:
        person: the participant's folder.
        kind: one of ``KINDS``.

    Raises:
        ValueError: nothing is said, where something has to be.
        OSError: it cannot be written.
    """
    text = text.strip()
    if not text and kind != 'include':
        raise ValueError(f'--{kind} needs words: {"what is to be noted" if kind == "note" else "the reason"}')
    person.mkdir(parents=True, exist_ok=True)
    path = person / NAME
    is_torn = path.exists() and not path.read_bytes().endswith(b'\n')  # the machine stopped, or an editor left it so
    with path.open('a', newline='', encoding='utf-8') as file:
        lines = csv.writer(file, lineterminator='\n')
        if not file.tell():
            lines.writerow(Note._fields)
        elif is_torn:
            file.write('\n')
        lines.writerow(Note(time.strftime('%Y-%m-%dT%H:%M:%S%z'), kind, text))
        file.flush()
        os.fsync(file.fileno())


def read_notes(person: Path) -> list[Note]:
    """All lines; none when nothing was noted.

    Raises:
        ValueError: the file is damaged; the message names it.
    """
    path = person / NAME
    try:
        text = path.read_text(encoding='utf-8', errors='replace')
    except FileNotFoundError:
        return []
    return [_note(path, number, line) for number, line in _lines(text) if number > 1 or not _is_header(line)]


def _lines(text: str) -> list[tuple[int, str]]:
    """The lines of a file of notes with their numbers; a note with several lines in quotes is one of them.

    Quotes that were torn open end where the next note begins: they hide none.
    """
    found: list[tuple[int, str]] = []
    for number, line in enumerate(text.split('\n'), start=1):
        if found and found[-1][1].count('"') % 2 and not _BEGINNING.match(line):
            first, before = found.pop()
            found.append((first, f'{before}\n{line}'))
        elif line.strip():
            found.append((number, line))
    return found


def _is_header(line: str) -> bool:
    return _columns(line) == list(Note._fields)


def _columns(line: str) -> list[str]:
    """What stands in the columns of a line; none when it is no line of a table."""
    try:
        return next(csv.reader(io.StringIO(line, newline='')))
    except csv.Error:
        return []


def _note(path: Path, number: int, line: str) -> Note:
    columns = _columns(line)
    if len(columns) != len(Note._fields):
        raise ValueError(f'{path} is damaged: its columns are to be {", ".join(Note._fields)}; mend line {number}, or '
                         'take it out')
    note = Note(*columns)
    if note.kind not in KINDS:
        raise ValueError(f'{path}, line {number}: kind is {note.kind!r}, expected {", ".join(KINDS)}')
    return note


def why_excluded(notes: list[Note]) -> str | None:
    """Why a participant is left out of the report; None: they are not. The last word counts."""
    said = [note for note in notes if note.kind != 'note']
    return said[-1].text if said and said[-1].kind == 'exclude' else None
