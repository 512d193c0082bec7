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

"""The folder of a study: the plan, a folder for each run, and one for each real participant."""

from contextlib import suppress
from pathlib import Path
from typing import IO

from shared_control.files import lock, write_atomically

from .plan import Job, Participant, Plan, plan_of, read_plan

_OF_A_REPORT = (
    'report.html', 'data/participants.csv', 'data/runs.csv', 'data/conditions.csv', 'data/comparisons.csv',
    'data/groups.csv', 'data/cells.csv', 'data/transfer.csv', 'data/fig[0-9]*_*.csv', 'figures/fig[0-9]*_*.png',
    'figures/fig[0-9]*_*.svg', 'figures/fig[0-9]*_*.pdf')
"""What a report writes. Its modules take seconds to load, so the names stand here once more."""


class StudyError(OSError):
    """A study cannot go on; the message says why and what to do."""


class StudyFolder:
    """Paths of everything that a study keeps.

        plan.yaml                         as it was begun with
        runs/CONDITION/pNN/               policy, episodes, tests and result of a run
        people/pNN/                       a real participant: progress.json, notes.csv, a session for each condition
        report/                           of all of it, unless another place was named

    Args:
        path: of the folder.
    """

    def __init__(self, path: Path):
        self.path = path
        self.plan = path / 'plan.yaml'
        self.report = path / 'report'
        self._lock: IO[bytes] | None = None

    @staticmethod
    def is_at(path: Path) -> bool:
        """Whether there is a study in ``path``."""
        return (path / 'plan.yaml').is_file()

    def run(self, job: Job) -> Path:
        """The folder of a run."""
        return self.path / 'runs' / job.name

    def person(self, participant: Participant) -> Path:
        """The folder of a real participant."""
        return self.path / 'people' / participant.label

    def session(self, job: Job) -> Path:
        """The folder of the session in which a real participant teaches."""
        return self.person(job.participant) / job.condition.name

    def remove_report(self) -> None:
        """Remove the report, which has what everybody did and said; what somebody else put there stays.

        Raises:
            OSError: it cannot be removed.
        """
        for pattern in _OF_A_REPORT:
            for path in self.report.glob(pattern):
                path.unlink()
        for folder in (self.report / 'data', self.report / 'figures', self.report):
            with suppress(OSError):  # not empty, or not there
                folder.rmdir()

    def without_path(self, text: str) -> str:
        """A text for what is passed on: whose machine the folder was on is nobody's business."""
        return text.replace(f'{self.path}/', '')

    def begin(self, plan_file: Path, number: int | None = None, quick: bool = False,
              claims: bool = True) -> Plan:
        """Make the folder, or take it up again; gives the plan.

        Args:
            plan_file: what the folder was, or will be, begun with.
            number: claim a participant's folder for this process alone; when None, the runs.
            quick: it is begun with the quick form of the plan.
            claims: False claims nothing: another process may be at work there.

        Raises:
            PlanError: the plan cannot be used, or has no such participant.
            StudyError: the folder belongs to another plan, is in use, or cannot be written.
        """
        text = read_plan(plan_file, quick)
        plan = plan_of(text, plan_file)
        try:
            claimed = self.path if number is None else self.person(plan.participant(number))
            claimed.mkdir(parents=True, exist_ok=True)
            if claims:
                self._lock = (claimed / '.lock').open('ab')
                lock(self._lock)
            if not self.plan.exists():
                write_atomically(self.plan, text)
        except BlockingIOError as error:
            raise StudyError(
                f'{claimed} is in use: this study is running already; wait for its end, or end it') from error
        except OSError as error:
            raise StudyError(f'cannot write the study folder {self.path}: {error.strerror}') from error
        if self.plan.read_bytes() != text:
            raise StudyError(f'{self.path} holds a study that was begun with another plan ({self.plan}): '
                             f'choose another --output, or run {self.plan}')
        return plan
