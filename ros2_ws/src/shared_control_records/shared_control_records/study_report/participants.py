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

"""Real participants: a tidy table of what they did and said, and how many came how far."""

from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from ..study.folder import StudyFolder
from ..study.notes import read_notes, why_excluded
from ..study.plan import Participant, Plan
from ..study.progress import SCALES, Progress


class Turnout(NamedTuple):
    """Numbers of participants."""

    planned: int
    began: int
    """Those who agreed to take part."""
    finished: int
    """Those who taught in every condition, and have not withdrawn."""
    withdrew: int
    excluded: int


def excluded_participants(folder: StudyFolder, plan: Plan) -> dict[int, str]:
    """Who is left out of the report by the experimenter, and why.

    Raises:
        ValueError: notes are damaged.
    """
    if plan.people is None:
        return {}
    reasons = {participant.number: why_excluded(read_notes(folder.person(participant)))
               for participant in plan.participants}
    return {number: reason for number, reason in reasons.items() if reason is not None}


def turnout(folder: StudyFolder, plan: Plan) -> Turnout:
    """How many came how far.

    Raises:
        ValueError: the progress or the notes of somebody are damaged.
    """
    everybody = [Progress.of(folder.person(participant)) for participant in plan.participants]
    taught = sum(condition.taught for condition in plan.conditions)
    withdrew = [progress for progress in everybody if progress.withdrawn]
    return Turnout(
        planned=len(everybody), began=sum(bool(progress.consented or progress.withdrawn) for progress in everybody),
        finished=sum(len(progress.taught) == taught and not progress.withdrawn for progress in everybody),
        withdrew=len(withdrew), excluded=len(excluded_participants(folder, plan)))


def participants_table(folder: StudyFolder, plan: Plan) -> pd.DataFrame:
    """A row for every participant who has begun and condition that they teach in, in their order.

    Columns are the same whatever was answered: who, order, dates, what the practice came to, scales of NASA-TLX (0 to
    100) and their mean, answers, and what the experimenter noted.

    Raises:
        ValueError: the progress or the notes of somebody are damaged.
    """
    rows = [row for participant in plan.participants for row in _rows(folder, plan, participant)]
    return pd.DataFrame(rows, columns=list(_row(plan, Progress(), {})))


def _rows(folder: StudyFolder, plan: Plan, participant: Participant) -> list[dict[str, Any]]:
    person = folder.person(participant)
    progress, notes = Progress.of(person), read_notes(person)
    if not (progress.consented or progress.withdrawn or notes):
        return []
    of_person = {'participant': participant.number, 'excluded': why_excluded(notes) or '',
                 'notes': ' | '.join(f'{note.at} {note.text}' for note in notes if note.kind == 'note')}
    return [_row(plan, progress, {**of_person, 'condition': condition.name, 'position': position})
            for position, condition in enumerate(plan.order(participant), start=1)]


def _row(plan: Plan, progress: Progress, about: dict[str, Any]) -> dict[str, Any]:
    people, condition = plan.people, about.get('condition')
    assert people is not None, 'participants of this study are simulated'
    practice, scales = progress.practice or {}, progress.tlx.get(condition or '', {})
    answered = [scales.get(name, np.nan) for name in SCALES]
    return {
        'participant': about.get('participant'), 'condition': condition, 'position': about.get('position'),
        'taught': condition in progress.taught, 'consented': progress.consented or '',
        'consent_sha256': progress.consent_sha256 or '', 'withdrawn': progress.withdrawn or '',
        'excluded': about.get('excluded'),
        **{f'practice_{name}': practice.get(name) for name in ('rests', 'met', 'seconds')},
        **{f'tlx_{name}': value for name, value in zip(SCALES, answered, strict=True)}, 'tlx': np.mean(answered),
        **{f'before_{name}': progress.before.get(name, '') for name in people.before},
        **{f'after_{name}': progress.after.get(name, '') for name in people.after},
        'notes': about.get('notes')}
