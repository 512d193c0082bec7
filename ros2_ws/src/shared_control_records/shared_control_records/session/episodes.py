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

"""The agent's table of episodes."""

import csv
import io
import math
from dataclasses import dataclass
from pathlib import Path

from shared_control.files import write_atomically
from shared_control.verdict import Verdict


@dataclass(frozen=True)
class EpisodeRow:
    """One episode; what the table does not tell is None."""

    number: int
    phase: str
    """``teach``, ``test``, or ``broken off``"""
    seconds: float | None
    episode_return: float | None
    fallen: bool | None
    human_share: float | None
    """Mean of |human| / (|human| + |robot|) over the moments of the steps, 0..1"""
    intervention_rate: float | None = None
    """Part of the steps in which the human gave a moment, 0..1"""
    verdict: Verdict = Verdict.NONE
    """What a person has said of it."""
    reason: str = ''
    """Why it was broken off, where that is known."""

    @property
    def counts(self) -> bool:
        """Whether nobody has discarded it."""
        return self.verdict is not Verdict.DISCARD


def read_episodes(path: Path) -> list[EpisodeRow]:
    """The rows of ``episodes.csv``; none when the file is missing. Columns are found by name, others ignored.

    Raises:
        ValueError: a row is not what it should be; the message names file and line.
    """
    if not path.is_file():
        return []
    rows = []
    try:
        content = list(csv.DictReader(path.read_text(encoding='utf-8').splitlines()))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f'{path} is no table of episodes: {error}') from error
    for line, row in enumerate(content, start=2):
        try:
            fallen = _number(row, 'fallen')
            rows.append(EpisodeRow(
                number=int(row['episode']), phase=row['phase'], seconds=_number(row, 'seconds'),
                episode_return=_number(row, 'return'), fallen=None if fallen is None else bool(fallen),
                human_share=_number(row, 'human_share'),
                intervention_rate=_number(row, 'intervention_rate'),
                verdict=Verdict(row.get('verdict') or ''), reason=row.get('reason') or ''))
        except (KeyError, ValueError, TypeError) as error:
            raise ValueError(f'{path}, line {line}: no usable episode ({error!r})') from error
    return rows


def write_episodes(rows: list[EpisodeRow], path: Path) -> None:
    """Write a table that :func:`read_episodes` reads; what is None stays empty."""
    text = io.StringIO(newline='')
    writer = csv.writer(text)
    writer.writerow(
        ('episode', 'phase', 'seconds', 'return', 'fallen', 'human_share', 'intervention_rate', 'verdict', 'reason'))
    writer.writerows((row.number, row.phase, row.seconds, row.episode_return,
                      None if row.fallen is None else int(row.fallen), row.human_share, row.intervention_rate,
                      row.verdict, row.reason)
                     for row in rows)
    write_atomically(path, text.getvalue().encode())


def _number(row: dict[str, str], column: str) -> float | None:
    text = row.get(column)
    if not text:
        return None
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f'{column} is {text}')
    return value
