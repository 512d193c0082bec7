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
import os
import time
from pathlib import Path
from typing import NamedTuple

NAME = 'notes.csv'
"""In a participant's folder."""
KINDS = ('note', 'exclude', 'include')


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
    with (person / NAME).open('a', newline='', encoding='utf-8') as file:
        lines = csv.writer(file, lineterminator='\n')
        if not file.tell():
            lines.writerow(Note._fields)
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
        with path.open(newline='', encoding='utf-8') as file:
            notes = [Note(**row) for row in csv.DictReader(file)]
    except FileNotFoundError:
        return []
    except (TypeError, ValueError, csv.Error) as error:
        raise ValueError(f'{path} is damaged: its columns are to be {", ".join(Note._fields)}') from error
    for line, note in enumerate(notes, start=2):
        if note.kind not in KINDS:
            raise ValueError(f'{path}, line {line}: kind is {note.kind!r}, expected {", ".join(KINDS)}')
    return notes


def why_excluded(notes: list[Note]) -> str | None:
    """Why a participant is left out of the report; None: they are not. The last word counts."""
    said = [note for note in notes if note.kind != 'note']
    return said[-1].text if said and said[-1].kind == 'exclude' else None
