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

"""A real participant's way through a study; the sessions are made up, questions and answers are not."""

import csv
import hashlib
import json
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from shared_control.cli import main
from shared_control_records.session.folder import SessionFolder
from shared_control_records.study import job as job_module
from shared_control_records.study.asking import TerminalAsker
from shared_control_records.study.folder import StudyError, StudyFolder
from shared_control_records.study.form_page import FormPage
from shared_control_records.study.job import run_job, taught_by_a_person
from shared_control_records.study.notes import add_note, read_notes, why_excluded
from shared_control_records.study.people import INTERRUPTED, asker_of, lead_through, withdraw
from shared_control_records.study.plan_file import Question
from shared_control_records.study.progress import SCALES, Progress, ProgressError
from shared_control_records.study.result import load_brief, save_result
from shared_control_records.study_report.participants import excluded_participants, participants_table, turnout
from shared_control_records.study_report.report import write_study_report
from shared_control_testing.studies import made_result

PLAN = """
participants:
  real: 2
  consent: You may stop at any time.
  practice_rests: 1
  practice_minutes: 3
  minutes: 30
  teach_on: terminal
  session_options: [--params-file, own.yaml]
  before: {age: {ask: "How old are you?", choices: [18 to 30, older]}}
  after: {comment: {ask: "What do you want to say?"}}
conditions: {coached: , thesis: }
"""
BEGINNING = ('yes', '1')
"""Answers to consent and age."""


class Sessions:
    """In place of ``shared-control session``: remembers how it was called, and ends as told."""

    def __init__(self, *codes):
        self.codes = list(codes)
        self.calls = []

    def __call__(self, arguments):
        self.calls.append(arguments)
        if '--output' in arguments:
            folder = Path(arguments[arguments.index('--output') + 1])
            (folder / 'learner').mkdir(parents=True)
            (folder / 'settings.json').write_text('{}')
            (folder / 'learner' / 'practice.json').write_text('{"rests": 1, "met": true}')
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


def lead(study, sessions):
    folder, plan = study
    return lead_through(folder, plan, plan.participant(1), TerminalAsker(), sessions)


def progress_of(study):
    folder, plan = study
    return Progress.of(folder.person(plan.participant(1)))


def test_a_terminal_at_which_nobody_answers_says_how_to_go_on(tmp_path, monkeypatch, capsys):
    def at_its_end(_=''):
        raise EOFError

    (tmp_path / 'plan.yaml').write_text(PLAN)
    monkeypatch.setattr('builtins.input', at_its_end)
    monkeypatch.setattr('sys.argv', ['shared-control', 'study', str(tmp_path / 'plan.yaml'), '--participant', '1',
                                     '--output', str(tmp_path / 'study')])
    assert main() == INTERRUPTED
    assert 'nobody answers any more: the same command goes on where it was' in capsys.readouterr().err


def test_consent_practice_teaching_and_questions_in_this_order(study, answers):
    folder, plan = study
    sessions = Sessions()
    thesis = ('10', 'a lot', '101', '20', 'back', '25', '30', '40', '50', '60')
    answers(*BEGINNING, '', *'123456', '', *thesis, 'Nothing.')
    assert lead(study, sessions)
    person = folder.person(plan.participant(1))
    assert [call[call.index('--output') + 1] for call in sessions.calls] == [
        str(person / name) for name in ('coached', 'thesis')]
    for call, preset, rests in zip(sessions.calls, ('coached', 'thesis'), ('1', '0'), strict=True):
        assert call[:2] == ['--tutor', 'keyboard'] and call[6:] == [
            '--blind', '--feedback', 'ball', '--no-verdicts', '--practice-rests', rests, '--practice-minutes', '3.0',
            '--minutes', '30.0', '--preset', preset, '--physics', 'bullet', '--sharing', 'additive',
            '--params-file', 'own.yaml']
    progress = progress_of(study)
    assert progress.taught == ['coached', 'thesis'] and progress.consented
    assert progress.consent_sha256 == hashlib.sha256(b'You may stop at any time.').hexdigest()
    assert progress.tlx['thesis'] == dict(zip(SCALES, (10, 25, 30, 40, 50, 60), strict=True))
    assert (progress.before, progress.after) == ({'age': '18 to 30'}, {'comment': 'Nothing.'})
    assert progress.practice == {'rests': 1, 'met': True}
    assert lead(study, Sessions()), 'nothing is left to do'


def test_without_consent_nothing_is_kept(study, answers):
    folder, plan = study
    answers('no')
    assert not lead(study, Sessions())
    assert [path.name for path in folder.person(plan.participant(1)).iterdir()] == ['.lock']


def test_what_was_interrupted_goes_on_there(study, answers):
    folder, plan = study
    answers(*BEGINNING, '', '1')
    sessions = Sessions(INTERRUPTED)
    assert not lead(study, sessions)
    answers('', '1', '2')
    with pytest.raises(StopIteration):  # in place of Ctrl-C at the third question
        lead(study, sessions)
    assert sessions.calls[1] == ['--resume', str(folder.person(plan.participant(1)) / 'coached')]
    answers('3', '4', '5', '6', '', *'123456', '')
    assert lead(study, sessions)
    assert list(progress_of(study).tlx['coached'].values()) == [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize(('choice', 'what', 'left'), [('2', 'keep', True), ('3', 'delete', False)])
def test_who_stops_may_leave_and_says_what_becomes_of_the_data(study, answers, choice, what, left):
    folder, plan = study
    run = folder.path / 'runs' / 'coached' / 'p01'
    run.mkdir(parents=True)
    answers(*BEGINNING, '', choice)
    assert not lead(study, Sessions(INTERRUPTED))
    assert (folder.person(plan.participant(1)) / 'coached').exists() is left and run.exists() is left
    progress = progress_of(study)
    assert progress.withdrawn == what and bool(progress.before) is left and bool(progress.consented) is left
    with pytest.raises(StudyError, match='participant 1 has withdrawn'):
        lead(study, Sessions())


def test_who_kept_may_have_it_deleted_later_and_not_the_other_way_round(study, answers):
    folder, plan = study
    participant = plan.participant(1)
    with pytest.raises(StudyError, match='has not begun'):
        withdraw(folder, plan, participant, 'keep')
    answers(*BEGINNING, '', '2')
    assert not lead(study, Sessions(INTERRUPTED))
    for what, then in (('keep', 'keep'), ('delete', 'delete'), ('keep', 'delete')):
        withdraw(folder, plan, participant, what)
        assert progress_of(study).withdrawn == then


def test_what_is_deleted_is_in_no_report_any_more(study, answers):
    folder, plan = study
    answers(*BEGINNING, '', *'123456', '', *'654321', 'Call me Zoe.')
    assert lead(study, Sessions())
    taught_session(study)
    run_job(folder, 'coached/p01')
    write_study_report(folder, folder.report)
    of_session = folder.person(plan.participant(1)) / 'coached_report'
    report = SessionFolder.create(of_session, settings={'tutor': 'page'})
    report.report.write_text('<html>')
    report.release()
    mine = folder.report / 'data' / 'mine.csv'
    mine.write_text('1')
    assert 'Zoe' in (folder.report / 'data' / 'participants.csv').read_text()
    withdraw(folder, plan, plan.participant(1), 'delete')
    assert not of_session.exists()
    assert [path for path in folder.report.rglob('*') if path.is_file()] == [mine], 'nothing of somebody else goes'
    kept = [path for path in folder.path.rglob('*') if path.is_file() and 'Zoe' in path.read_text(errors='replace')]
    assert kept == []


def test_a_session_that_fails_is_said_and_done_again(study, answers):
    answers(*BEGINNING, '')
    with pytest.raises(StudyError, match='coached failed'):
        lead(study, Sessions(1))
    assert not progress_of(study).taught


@pytest.mark.parametrize(('content', 'said'), [
    ({'name': 'Ann'}, 'name: is not known'), ({'taught': 'coached'}, 'taught: Input should be a valid'),
    ({'tlx': {'coached': {'mental': 101}}}, r'tlx\.coached\.mental: .*, found 101'), ([], 'should be')])
def test_a_damaged_progress_is_named(study, content, said):
    folder, plan = study
    (folder.person(plan.participant(1)) / 'progress.json').write_text(json.dumps(content))
    with pytest.raises(ProgressError, match=rf'progress\.json is damaged: {said}'):
        Progress.of(folder.person(plan.participant(1)))


class Visitor:
    """A browser without a screen."""

    def __init__(self, page):
        self._address = page.address

    def get(self, **headers):
        request = urllib.request.Request(self._address, headers=headers)
        return urllib.request.urlopen(request, timeout=60).read().decode()

    def headers(self):
        return urllib.request.urlopen(self._address, timeout=60).headers

    def post(self, body, **headers):
        request = urllib.request.Request(self._address, body, headers)
        return urllib.request.urlopen(request, timeout=60).read().decode()

    def send(self, **fields):
        """Fill in the form that is shown; what comes then."""
        return self.send_in_order(*fields.items())

    def send_in_order(self, *fields):
        """The same, field by field, the form's own first: a browser sends as many of a name as there are."""
        key = self.get().partition('name="key" value="')[2].partition('"')[0]
        return self.post(urllib.parse.urlencode([('key', key), *fields]).encode())

    def fields(self):
        """The names of the fields for text that are shown, in their order."""
        return re.findall('<textarea name="([^"]*)"', self.get())


@pytest.fixture
def asked():
    """``asked(method, *arguments)``: a page that asks, a visitor, and how to wait for the answer."""
    with socket.create_server(('127.0.0.1', 0)) as free:
        page = FormPage(port=free.getsockname()[1])

    def ask(method, *arguments):
        given = []
        thread = threading.Thread(target=lambda: given.append(getattr(page, method)(*arguments)), daemon=True)
        thread.start()

        def answer():
            thread.join(60)
            return given[0]
        visitor = Visitor(page)
        for _ in range(200):
            try:
                visitor.get(**{'Sec-Fetch-Mode': 'cors'})  # as a script that looks whether there is something
                break
            except urllib.error.URLError:
                threading.Event().wait(0.05)
        return visitor, answer

    return ask


def test_a_page_asks_for_consent_and_shows_no_markup_of_the_text(asked):
    visitor, answer = asked('consent', 'Do <b>you</b> agree?\nYou may stop.')
    assert 'Do &lt;b&gt;you&lt;/b&gt; agree?' in visitor.get()
    assert 'I do not agree' in visitor.send(choice='perhaps'), 'what is no answer is asked again'
    assert 'Thank you' in visitor.send(choice='no')
    assert answer() is False


@pytest.mark.parametrize('length', ['many', '-1', '1.5'])
def test_an_answer_of_no_length_is_none(asked, length):
    visitor, answer = asked('ready', 'Sit down.')
    assert 'name="choice"' in visitor.post(b'choice=go_on', **{'Content-Length': length})
    visitor.send(choice='go_on')
    answer()


def test_a_page_asks_for_the_workload(asked):
    kept = {}
    visitor, answer = asked('rate', 'How was it?', SCALES, kept.__setitem__)
    assert visitor.get().count('type="range"') == len(SCALES)
    for wrong in ({'mental': '5'}, {**dict.fromkeys(SCALES, '5'), 'effort': '101'}, dict.fromkeys(SCALES, 'nan')):
        assert 'type="range"' in visitor.send(**wrong)
    visitor.send(**dict.fromkeys(SCALES, '35'))
    answer()
    assert kept == dict.fromkeys(SCALES, 35.0)


def test_a_page_asks_the_questions_of_the_plan(asked):
    questions = {'age': Question(ask='Your age?', choices=['18 to 30', 'older']), 'comment': Question(ask='And?')}
    visitor, answer = asked('answer', 'Before you begin', questions)
    assert 'Your age?' in visitor.send(answer_0='12', answer_1='')
    visitor.send(answer_0='older', answer_1=' fine ')
    assert answer() == {'age': 'older', 'comment': 'fine'}


def test_questions_may_have_any_name(asked):
    names = ['key', 'choice', 'answer_0', 'querySelectorAll', '', 'two\nlines', '"><b>']
    visitor, answer = asked('answer', 'Before you begin', {name: Question(ask='What?') for name in names})
    fields = visitor.fields()
    assert len(set(fields)) == len(names) and all(fields)
    assert 'Thank you' in visitor.send_in_order(*zip(fields, map(str, range(len(names))), strict=True))
    assert answer() == {name: str(number) for number, name in enumerate(names)}


def test_a_choice_may_begin_with_a_space(asked):
    question = Question(ask='Which hand?', choices=[' left', 'right '])
    visitor, answer = asked('answer', 'Before you begin', {'hand': question})
    visitor.send(answer_0=' left')
    assert answer() == {'hand': ' left'}


def test_an_address_that_is_in_use_is_named():
    with socket.create_server(('127.0.0.1', 0)) as used:
        port = used.getsockname()[1]
        for method, *arguments in (('consent', 'Do you agree?'), ('tell', 'That was all.')):
            with pytest.raises(OSError, match=rf'questions at 127\.0\.0\.1:{port} \(Address already in use\): end'):
                getattr(FormPage(port=port), method)(*arguments)


def test_the_last_page_ends_by_itself_once_it_is_shown(asked):
    visitor, answer = asked('tell', 'That was all. Thank you.')
    assert 'You can close this window.' in visitor.get(**{'Sec-Fetch-Mode': 'navigate'})
    answer()


@pytest.mark.parametrize('header', [
    {'Host': 'evil.example'}, {'Host': '['}, {'Host': ''}, {'Origin': 'http://evil.example'}, {'Origin': 'http://['}])
def test_other_pages_may_not_speak_to_the_form(asked, header):
    visitor, answer = asked('ready', 'Sit down.')
    assert "frame-ancestors 'self'" in visitor.headers()['Content-Security-Policy']
    with pytest.raises(urllib.error.HTTPError) as refused:
        visitor.get(**header)
    assert refused.value.code == 403
    visitor.send(choice='go_on')
    answer()


@contextmanager
def study_in_a_session(folder, session, **pipes):
    """A process that is in a session, which is the shell script ``session``, and has got as far as to write a file."""
    script, started = folder / 'session', folder / 'started'
    script.write_text('#!/bin/sh\n' + session.replace('STARTED', f'echo > {started}'))
    script.chmod(0o755)
    code = ('import sys\nfrom shared_control_records.study import people\n'
            f'sys.executable = {str(script)!r}\npeople.session([])')
    with subprocess.Popen([sys.executable, '-c', code], **pipes) as study:
        while not started.exists():
            assert study.poll() is None
            time.sleep(0.02)
        yield study


@pytest.mark.parametrize('end', [signal.SIGTERM, signal.SIGKILL])
def test_a_session_ends_with_its_study(end, tmp_path):
    with study_in_a_session(tmp_path, 'STARTED\nexec sleep 600\n', stdout=subprocess.PIPE) as study:
        study.send_signal(end)
        study.communicate(timeout=60)  # until the last process that has its output is gone


def test_a_session_is_waited_for_when_its_study_is_interrupted(tmp_path):
    written = tmp_path / 'written'
    session = f'trap "sleep 1; echo > {written}; exit" TERM\nSTARTED\nwhile :; do sleep 0.1; done\n'
    with study_in_a_session(tmp_path, session, stderr=subprocess.PIPE) as study:
        study.send_signal(signal.SIGINT)
        time.sleep(0.5)
        study.send_signal(signal.SIGINT)
        assert b'KeyboardInterrupt' in study.communicate(timeout=60)[1]
    assert written.exists()


def test_people_are_asked_where_they_teach(study):
    _, plan = study
    people = plan.people.model_copy(update={'teach_on': 'page', 'session_options': []})
    assert asker_of(people).address == 'http://127.0.0.1:8088/'
    for options in (['--page', '127.0.0.1:9000'], ['--page=127.0.0.1:9000'], ['--page', '[::1]:9000']):
        host_and_port = options[-1].removeprefix('--page=')
        assert asker_of(people.model_copy(update={'session_options': options})).address == f'http://{host_and_port}/'
    for wrong in ('0.0.0.0:8088', '127.0.0.1:0', '127.0.0.1'):
        with pytest.raises(ValueError):
            asker_of(people.model_copy(update={'session_options': ['--page', wrong]}))


def test_a_terminal_breaks_lines_between_words(monkeypatch, capsys):
    monkeypatch.setenv('COLUMNS', '30')
    TerminalAsker().tell('A consent that is longer than the terminal is wide.\n\nStop at any time.')
    lines = capsys.readouterr().out.splitlines()
    assert lines == ['A consent that is longer than', 'the terminal is wide.', '', 'Stop at any time.']


def study_command(study, *arguments):
    folder, _ = study
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr('sys.argv', ['shared-control', 'study', str(folder.plan), '--output', str(folder.path),
                                   '--participant', '1', *arguments])
        return main()


def test_the_experimenter_notes_while_somebody_takes_part_and_leaves_them_out(study, answers, capsys):
    folder, plan = study  # which holds the participant's lock
    answers(*BEGINNING, '', *'123456', '', *'654321', 'Nothing.')
    assert lead(study, Sessions())
    assert study_command(study, '--note', 'the phone rang, "twice"') == 0
    assert study_command(study, '--exclude', ' ') == 2 and '--exclude needs words' in capsys.readouterr().err
    assert study_command(study, '--exclude', 'pressed with the mouse') == 0
    assert excluded_participants(folder, plan) == {1: 'pressed with the mouse'}

    rows = participants_table(folder, plan)
    assert rows.participant.tolist() == [1, 1] and rows.position.tolist() == [1, 2]
    assert rows.condition.tolist() == ['coached', 'thesis'] and rows.taught.all() and rows.consented.all()
    assert rows.tlx_mental.tolist() == [1, 6] and rows.tlx.tolist() == [3.5, 3.5]
    assert set(rows.before_age) == {'18 to 30'} and set(rows.after_comment) == {'Nothing.'}
    assert set(rows.practice_rests) == {1} and set(rows.excluded) == {'pressed with the mouse'}
    assert rows.notes[0].endswith('the phone rang, "twice"')
    assert turnout(folder, plan) == (2, 1, 1, 0, 1)

    assert study_command(study, '--include') == 0
    assert excluded_participants(folder, plan) == {} and set(participants_table(folder, plan).excluded) == {''}
    assert [note.kind for note in read_notes(folder.person(plan.participant(1)))] == ['note', 'exclude', 'include']
    withdraw(folder, plan, plan.participant(1), 'delete')
    assert read_notes(folder.person(plan.participant(1))) == [] and turnout(folder, plan) == (2, 1, 0, 1, 0)


def taught_session(study, *rows, successes=None):
    """A session of participant 1 that came to its end: rows are number, phase, verdict; of 10 s and 1 s of learning."""
    folder, plan = study
    job = next(job for job in plan.jobs if job.name == 'coached/p01')
    session = SessionFolder(folder.session(job))
    session.learner.mkdir(parents=True, exist_ok=True)
    session.settings.write_text('{"tutor": "page"}')
    session.episodes.write_text('episode,phase,seconds,learn_seconds,return,fallen,verdict,reason\n' + ''.join(
        f'{number},{phase},10,1,5,0,{verdict},\n' for number, phase, verdict in rows))
    if successes is not None:
        session.policy.write_bytes(b'')
        episode = {'kept': True, 'position_error': 0.0, 'velocity': 0.0, 'ball_start': 0.0}
        session.test.write_text(json.dumps({
            'episodes': [{**episode, 'success': number < successes} for number in range(20)]}))
    return session, lambda: taught_by_a_person(folder, plan, job)


def test_an_episode_that_was_discarded_and_done_again_counts_once_and_its_time_is_spent(study, monkeypatch):
    monkeypatch.setattr(job_module, 'run_tests', lambda *_: {})
    _, test = taught_session(
        study, (1, 'teach', ''), (2, 'teach', 'discard'), (2, 'broken off', ''), (2, 'teach', 'success'),
        (3, 'teach', 'discard'), (3, 'teach', ''), (4, 'teach', 'discard'), successes=19)
    run = test()
    assert [(row['episode'], row['verdict']) for row in run.episodes] == [(1, ''), (2, 'success'), (3, '')]
    assert run.skilled == 3 and run.seconds == 7 * 11.0
    _, test = taught_session(study, (1, 'teach', ''), (2, 'teach', 'discard'), (3, 'teach', ''), successes=18)
    run = test()
    assert len(run.episodes) == 3, 'discarded while the next one ran: the robot has kept it'
    assert run.skilled is None


@pytest.mark.parametrize('rows', [(), ((1, 'teach', 'discard'), (1, 'broken off', ''))])
def test_who_taught_to_the_end_and_left_no_policy_is_in_every_figure_as_lost(study, rows, answers, tmp_path):
    folder, plan = study
    answers(*BEGINNING, '', *'123456', '', *'654321', 'Nothing.')
    assert lead(study, Sessions())
    taught_session(study, *rows)
    run_job(folder, 'coached/p01')
    assert (load_brief(folder.run(plan.jobs[0])).skilled, load_brief(folder.run(plan.jobs[0])).seconds) == (
        None, 11.0 * len(rows))
    write_study_report(folder, tmp_path / 'alone')

    good = next(job for job in plan.jobs if job.name == 'coached/p02')
    folder.run(good).mkdir(parents=True)
    save_result(made_result(good, np.random.default_rng(1)), folder.run(good))
    page = write_study_report(folder, tmp_path / 'both').read_text()
    assert '1 of 2 runs got there' in page
    table = pd.read_csv(tmp_path / 'both/data/conditions.csv').set_index('measure')
    assert table.basis['Episodes to skilled (median)'] == '1 of 2 skilled'
    assert table.value['Randomised test: episodes that succeed'] == 50.0
    assert table.value['Trajectory tests: ball kept'] == 50.0
    lost = pd.read_csv(tmp_path / 'both/data/runs.csv').set_index('participant').loc[1]
    assert [lost.episodes, lost.kept, lost.success, lost.alone_error, lost.pushed_error, lost.moving_error] == [
        0, 0, 0, 20, 20, 20]


def test_a_session_whose_files_do_not_belong_together_is_named(study):
    session, test = taught_session(study, (1, 'teach', ''))
    with pytest.raises(ValueError, match=r'episodes\.csv and .*policy\.safetensors do not belong .* is missing'):
        test()
    session.policy.write_bytes(b'')
    with pytest.raises(FileNotFoundError, match=r'test\.json is missing: shared-control session --resume .*coached'):
        test()
    session.episodes.unlink()
    with pytest.raises(ValueError, match=r'do not belong .* 0 episodes .* is there; take both from a back-up'):
        test()


def test_what_people_said_is_a_table_before_anything_is_tested(study, answers, tmp_path):
    folder, _ = study
    answers(*BEGINNING, '', '1')
    assert not lead(study, Sessions(INTERRUPTED))
    with pytest.raises(ValueError, match=r'no run of the study .* is done yet: shared-control study does'):
        write_study_report(folder, tmp_path / 'report')
    with (tmp_path / 'report/data/participants.csv').open() as file:
        rows = list(csv.DictReader(file))
    assert [(row['condition'], row['taught'], row['tlx']) for row in rows] == [
        ('coached', 'False', ''), ('thesis', 'False', '')]


@pytest.mark.parametrize(('torn', 'kept'), [
    (b'now,exclude,"the phone rang, and', ['the phone rang, and']), (b'now,exclude,"said ""no', ['said "no']),
    (b'now,note,caf\xc3', ['caf\ufffd']), (b'now,note,left by an editor', ['left by an editor'])])
def test_a_line_that_was_torn_off_hides_no_later_one(tmp_path, torn, kept):
    add_note(tmp_path, 'exclude', 'came late')
    with (tmp_path / 'notes.csv').open('ab') as file:
        file.write(torn)
    assert [note.text for note in read_notes(tmp_path)] == ['came late', *kept]
    add_note(tmp_path, 'include', '')
    add_note(tmp_path, 'note', 'two\nlines,\u2028"quoted"')
    notes = read_notes(tmp_path)
    assert [note.text for note in notes] == ['came late', *kept, '', 'two\nlines,\u2028"quoted"']
    assert why_excluded(notes) is None


def test_a_line_that_was_torn_off_before_its_text_is_named(tmp_path):
    add_note(tmp_path, 'note', 'one\nand two')
    with (tmp_path / 'notes.csv').open('a') as file:
        file.write('2026-11-27T21:08:00+0000,excl')
    add_note(tmp_path, 'include', '')
    with pytest.raises(ValueError, match=r'notes\.csv is damaged: .*mend line 4, or take it out'):
        read_notes(tmp_path)


@pytest.mark.parametrize(('content', 'said'), [
    ('a,b\n1,2\n', 'is damaged: its columns'), ('at,kind,text\n1,2,3,4\n', 'is damaged: its columns'),
    ('at,kind,text\nnow,note,' + 'long' * 50_000, 'is damaged: its columns'),
    ('at,kind,text\nnow,praise,good\n', "line 2: kind is 'praise', expected note")],
    ids=['other columns', 'too many', 'too long', 'unknown kind'])
def test_damaged_notes_are_named(study, content, said):
    folder, plan = study
    (folder.person(plan.participant(1)) / 'notes.csv').write_text(content)
    with pytest.raises(ValueError, match=rf'notes\.csv.*{said}'):
        excluded_participants(folder, plan)
