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

"""A real participant: consent, questions, practice, teaching, questionnaire, on a page or at the terminal."""

import hashlib
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from shared_control.processes import leave_with_the_parent
from shared_control_learning.practice import PRACTICE_NAME

from ..session.folder import SessionFolder, report_beside
from .asking import Asker, TerminalAsker
from .folder import StudyError, StudyFolder
from .form_page import FormPage
from .notes import NAME as NOTES
from .plan import Condition, Job, Participant, People, Plan
from .progress import SCALES, Progress

INTERRUPTED = 130
"""Exit code of a session that was stopped before its end."""
TUTOR = {'page': 'page', 'terminal': 'keyboard'}
"""The session's ``--tutor`` by where they teach."""

RunSession = Callable[[list[str]], int]
"""Runs ``shared-control session`` with some arguments; gives its exit code."""


def session(arguments: list[str]) -> int:
    """Run a session at this terminal; it ends with the study, which waits until all is written."""
    with subprocess.Popen([sys.executable, '-m', 'shared_control', 'session', *arguments],
                          preexec_fn=leave_with_the_parent) as process:
        try:
            return process.wait()
        except KeyboardInterrupt:
            process.terminate()
            _wait_however_often_asked(process)
            raise


def _wait_however_often_asked(process: subprocess.Popen) -> None:
    while process.returncode is None:
        with suppress(KeyboardInterrupt):
            process.wait()


def asker_of(people: People) -> Asker:
    """How participants are asked; on a page, its address is printed.

    Raises:
        ValueError: the page would be open to the network.
    """
    if people.teach_on == 'terminal':
        return TerminalAsker()
    host, port = '127.0.0.1', 8088
    if (given := _page_option(people.session_options)) is not None:
        host, _, number = given.rpartition(':')
        if not number.isdecimal() or not 0 < int(number) < 65536:
            raise ValueError(f'--page {given}: a study needs HOST:PORT with a port from 1 to 65535')
        host, port = host.strip('[]'), int(number)  # as argparse reads it for the session
    page = FormPage(host, port)
    print(f'\n    The participant is asked, and teaches, here: {page.address}\n', flush=True)
    return page


def lead_through(folder: StudyFolder, plan: Plan, participant: Participant, asker: Asker,
                 run_session: RunSession = session) -> bool:
    """Lead a participant through what is left to do; False when they stopped before the end.

    Raises:
        StudyError: a session failed, or the participant has withdrawn.
        EOFError: nobody answers.
    """
    people = plan.people
    assert people is not None, 'participants of this study are simulated'
    progress = Progress.of(folder.person(participant))
    if progress.withdrawn:
        raise StudyError(f'participant {participant.number} has withdrawn from this study: who comes instead has '
                         'another number')
    if not progress.consented and not _consent(people, progress, asker):
        return False
    if people.before and not progress.before:
        progress.before = asker.answer('Before you begin', people.before)
        progress.save()
    order = plan.order(participant)
    for number, condition in enumerate(order, start=1):
        if condition.name not in progress.taught:
            path = folder.session(Job(participant, condition))
            if not _teach(path, condition, participant, people, progress, asker, run_session,
                          f'Part {number} of {len(order)}'):
                _ask_whether_to_withdraw(folder, plan, participant, asker)
                return False
            progress.taught.append(condition.name)
            progress.save()
        _ask_workload(progress, condition.name, asker, f'How was part {number} of {len(order)}?')
    if people.after and not progress.after:
        progress.after = asker.answer('At the end', people.after)
        progress.save()
    asker.tell('That was all. Thank you.')
    return True


def withdraw(folder: StudyFolder, plan: Plan, participant: Participant, what: str) -> None:
    """A participant takes no further part, and what was recorded is kept or deleted.

    Args:
        what: ``keep``: sessions that came to their end count. ``delete``: all that was recorded of them goes, with what
            reports have of it, but that they have withdrawn.

    Raises:
        StudyError: there is nobody of that number yet; or what was recorded cannot be removed.
    """
    person = folder.person(participant)
    progress = Progress.of(person)
    if not progress.consented and not progress.withdrawn:
        raise StudyError(f'participant {participant.number} has not begun: there is nothing to withdraw from')
    if what == 'delete':
        progress.forget()
    progress.withdrawn = 'delete' if what == 'delete' or progress.withdrawn == 'delete' else 'keep'
    progress.save()
    if what == 'delete':
        try:
            folder.remove_report()
            (person / NOTES).unlink(missing_ok=True)
            for job in plan.jobs:
                if job.participant == participant:
                    for path in (folder.session(job), folder.run(job)):
                        if path.exists():
                            shutil.rmtree(path)
                    report = SessionFolder(report_beside(folder.session(job)))
                    if report.holds_run:
                        report.discard()
        except OSError as error:
            raise StudyError(f'not everything of participant {participant.number} could be removed: {error}') from error


def _consent(people: People, progress: Progress, asker: Asker) -> bool:
    if not asker.consent(people.consent):
        asker.tell('You did not agree: nothing was recorded.')
        return False
    progress.consented = time.strftime('%Y-%m-%dT%H:%M:%S%z')
    progress.consent_sha256 = hashlib.sha256(people.consent.encode()).hexdigest()
    progress.save()
    return True


def _teach(path: Path, condition: Condition, participant: Participant, people: People, progress: Progress,
           asker: Asker, run_session: RunSession, part: str) -> bool:
    """Run a session, or go on with one; False when it was stopped before its end."""
    asker.ready(f'{part}\nFirst you alone move the tray, to practise. Then you teach the robot, which begins anew, for '
                f'at most {people.minutes:g} minutes, until you say that you are done. Rest first if you like.')
    if SessionFolder(path).settings.exists():
        code = run_session(['--resume', str(path)])
    else:
        rests = 0 if progress.practice else people.practice_rests
        code = run_session([
            '--tutor', TUTOR[people.teach_on], '--seed', str(participant.seed), '--output', str(path), '--blind',
            '--feedback', people.feedback, '--verdicts' if people.verdicts else '--no-verdicts',
            '--practice-rests', str(rests), '--practice-minutes', str(people.practice_minutes),
            '--minutes', str(people.minutes),
            *_learning(condition), *people.session_options])
    if progress.practice is None:
        progress.practice = SessionFolder(path).read_json(SessionFolder(path).learner / PRACTICE_NAME)
        progress.save()
    if code not in (0, INTERRUPTED):
        raise StudyError(f'the session in {path} failed (exit code {code}); its log/ tells more. '
                         'Start the same command again to go on')
    return code == 0


def _learning(condition: Condition) -> list[str]:
    task = ['--task', condition.task] if condition.task else []
    return ['--preset', condition.preset, *task, '--physics', condition.physics, '--sharing', condition.sharing]


def _ask_whether_to_withdraw(folder: StudyFolder, plan: Plan, participant: Participant, asker: Asker) -> None:
    choice = asker.choose(
        'You have stopped.\nYou may go on, now or another day, or leave the study, without a reason. If you leave, '
        'what was recorded of you can be kept, under your number, or deleted.',
        {'later': 'I go on', 'keep': 'I leave; keep what was recorded', 'delete': 'I leave; delete what was recorded'})
    if choice != 'later':
        withdraw(folder, plan, participant, choice)
    asker.tell({'later': 'You can go on where you stopped. Please tell the experimenter.',
                'keep': 'Thank you for taking part. What was recorded is kept, under your number.',
                'delete': 'Thank you for taking part. What was recorded is deleted.'}[choice])


def _ask_workload(progress: Progress, condition: str, asker: Asker, text: str) -> None:
    answers = progress.tlx.setdefault(condition, {})
    left = {name: scale for name, scale in SCALES.items() if name not in answers}

    def keep(name: str, value: float) -> None:
        answers[name] = value
        progress.save()
    if left:
        asker.rate(text, left, keep)


def _page_option(options: list[str]) -> str | None:
    """The value of ``--page``, in either way of writing it."""
    words = [word for option in options
             for word in (option.split('=', 1) if option.startswith('--page=') else [option])]
    return words[words.index('--page') + 1] if '--page' in words[:-1] else None
