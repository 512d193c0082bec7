"""A real participant at the terminal: consent, practice, teaching, questionnaire."""

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from ..session.folder import SessionFolder
from .folder import StudyError, StudyFolder
from .plan import Condition, Job, Participant, People, Plan
from .progress import SCALES, Progress

INTERRUPTED = 130
"""Exit code of a session that was stopped before its end."""

RunSession = Callable[[list[str]], int]
"""Runs ``shared-control session`` with some arguments; gives its exit code."""


def session(arguments: list[str]) -> int:
    """Run a session at this terminal."""
    return subprocess.run([sys.executable, '-m', 'shared_control', 'session', *arguments], check=False).returncode


def lead_through(folder: StudyFolder, plan: Plan, participant: Participant, run_session: RunSession = session) -> bool:
    """Lead a participant through what is left to do; False when they stopped before the end.

    Raises:
        StudyError: a session failed.
        EOFError: nobody answers.
    """
    people = plan.people
    assert people is not None, 'participants of this study are simulated'
    progress = Progress.of(folder.person(participant))
    order = plan.order(participant)
    if not progress.consented and not _consent(people, progress):
        return False
    if not progress.practised:
        practice = [*_learning(order[0]), '--episodes', str(people.practice_episodes), '--test-episodes', '0']
        if people.practice_episodes and not _run(
                folder.person(participant) / 'practice', practice, participant, people, run_session,
                'Practice: get to know the keys. This part does not count.'):
            return False
        progress.practised = True
        progress.save()
    for number, condition in enumerate(order, start=1):
        if condition.name not in progress.taught:
            if not _run(folder.session(Job(participant, condition)), _teaching(condition, people), participant, people,
                        run_session, f'Teaching, {number} of {len(order)}: press q twice when you are done; '
                                     f'after {people.minutes:g} minutes it ends by itself.'):
                return False
            progress.taught.append(condition.name)
            progress.save()
        _ask_workload(progress, condition.name)
    print(f'That was all, participant {participant.number}. Thank you.')
    return True


def _consent(people: People, progress: Progress) -> bool:
    print(people.consent)
    if input('\nDo you agree? Type yes or no: ').strip().lower() != 'yes':
        print('You did not agree: nothing was recorded.')
        return False
    progress.consented = time.strftime('%Y-%m-%dT%H:%M:%S%z')
    progress.save()
    return True


def _learning(condition: Condition) -> list[str]:
    task = ['--task', condition.task] if condition.task else []
    return ['--preset', condition.preset, *task, '--physics', condition.physics]


def _teaching(condition: Condition, people: People) -> list[str]:
    return [*_learning(condition), '--sharing', condition.sharing, '--minutes', str(people.minutes)]


def _run(path: Path, arguments: list[str], participant: Participant, people: People, run_session: RunSession,
         text: str) -> bool:
    """Run a session, or go on with one; False when it was stopped before its end."""
    print(f'\n{text}')
    input('Press Enter to begin. ')
    if _begun(path):
        code = run_session(['--resume', str(path)])
    else:
        code = run_session(['--tutor', 'keyboard', '--seed', str(participant.seed), '--output', str(path), '--blind',
                            *arguments, *people.session_options])
    if code not in (0, INTERRUPTED):
        raise StudyError(f'the session in {path} failed (exit code {code}); its log/ tells more. '
                         'Start the same command again to go on')
    return code == 0


def _begun(path: Path) -> bool:
    return SessionFolder(path).settings.exists()


def _ask_workload(progress: Progress, condition: str) -> None:
    answers = progress.tlx.setdefault(condition, {})
    if len(answers) < len(SCALES):
        print('\nHow was it? Answer each with a number from 0 (very low) to 100 (very high).')
    for scale, question in SCALES.items():
        while scale not in answers:
            try:
                value = float(input(f'  {question} '))
            except ValueError:
                value = -1.0
            if 0.0 <= value <= 100.0:
                answers[scale] = value
                progress.save()
            else:
                print('  A number from 0 to 100, please.')
