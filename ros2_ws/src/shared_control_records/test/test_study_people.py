"""A real participant's way through a study; the sessions are made up, questions and answers are not."""

import json
from pathlib import Path

import pytest
from shared_control_records.study.folder import StudyError, StudyFolder
from shared_control_records.study.people import INTERRUPTED, lead_through
from shared_control_records.study.progress import SCALES, Progress, ProgressError

PLAN = """
participants: {real: 2, consent: You may stop at any time., practice_episodes: 1, minutes: 30,
               session_options: [--params-file, own.yaml]}
conditions: {coached: , thesis: }
"""


class Sessions:
    """In place of ``shared-control session``: remembers how it was called, and ends as told."""

    def __init__(self, *codes):
        self.codes = list(codes)
        self.calls = []

    def __call__(self, arguments):
        self.calls.append(arguments)
        if '--output' in arguments:
            folder = Path(arguments[arguments.index('--output') + 1])
            folder.mkdir(parents=True)
            (folder / 'settings.json').write_text('{}')
        return self.codes.pop(0) if self.codes else 0


@pytest.fixture
def study(tmp_path):
    (tmp_path / 'plan.yaml').write_text(PLAN)
    folder = StudyFolder(tmp_path / 'study')
    return folder, folder.begin(tmp_path / 'plan.yaml', 1)


@pytest.fixture
def answers(monkeypatch):
    def give(*texts):
        waiting = iter(texts)
        monkeypatch.setattr('builtins.input', lambda _='': next(waiting))

    return give


def test_consent_practice_teaching_and_questions_in_this_order(study, answers):
    folder, plan = study
    sessions = Sessions()
    answers('yes', '', '', *'123456', '', '10', 'a lot', '101', '20', '30', '40', '50', '60')
    assert lead_through(folder, plan, plan.participant(1), sessions)
    person = folder.person(plan.participant(1))
    assert [call[call.index('--output') + 1] for call in sessions.calls] == [
        str(person / name) for name in ('practice', 'coached', 'thesis')]
    assert all('--blind' in call and call[-2:] == ['--params-file', 'own.yaml'] for call in sessions.calls)
    assert sessions.calls[0][7:-2] == [
        '--preset', 'coached', '--physics', 'bullet', '--episodes', '1', '--test-episodes', '0']
    assert sessions.calls[2][7:-2] == [
        '--preset', 'thesis', '--physics', 'bullet', '--sharing', 'additive', '--minutes', '30.0']
    progress = Progress.of(person)
    assert progress.taught == ['coached', 'thesis'] and progress.consented
    assert progress.tlx['thesis'] == dict(zip(SCALES, (10, 20, 30, 40, 50, 60), strict=True))
    assert lead_through(folder, plan, plan.participant(1), Sessions()), 'nothing is left to do'


def test_without_consent_nothing_is_kept(study, answers):
    folder, plan = study
    answers('no')
    assert not lead_through(folder, plan, plan.participant(1), Sessions())
    assert [path.name for path in folder.person(plan.participant(1)).iterdir()] == ['.lock']


def test_what_was_interrupted_goes_on_there(study, answers):
    folder, plan = study
    answers('yes', '', '')
    sessions = Sessions(0, INTERRUPTED)
    assert not lead_through(folder, plan, plan.participant(1), sessions)
    answers('', '1', '2')
    with pytest.raises(StopIteration):  # in place of Ctrl-C at the third question
        lead_through(folder, plan, plan.participant(1), sessions)
    assert sessions.calls[2] == ['--resume', str(folder.person(plan.participant(1)) / 'coached')]
    answers('3', '4', '5', '6', '', *'123456')
    assert lead_through(folder, plan, plan.participant(1), sessions)
    assert list(Progress.of(folder.person(plan.participant(1))).tlx['coached'].values()) == [1, 2, 3, 4, 5, 6]


def test_a_session_that_fails_is_said_and_done_again(study, answers):
    folder, plan = study
    answers('yes', '')
    with pytest.raises(StudyError, match='practice failed'):
        lead_through(folder, plan, plan.participant(1), Sessions(1))
    assert not Progress.of(folder.person(plan.participant(1))).practised


@pytest.mark.parametrize(('content', 'said'), [
    ({'name': 'Ann'}, 'name: is not known'), ({'taught': 'coached'}, 'taught: Input should be a valid'),
    ({'tlx': {'coached': {'mental': 101}}}, r'tlx\.coached\.mental: .*, found 101'), ([], 'should be')])
def test_a_damaged_progress_is_named(study, content, said):
    folder, plan = study
    (folder.person(plan.participant(1)) / 'progress.json').write_text(json.dumps(content))
    with pytest.raises(ProgressError, match=rf'progress\.json is damaged: {said}'):
        Progress.of(folder.person(plan.participant(1)))
