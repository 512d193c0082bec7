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

"""Summary, picture and report of a session, whole or with pieces missing."""

import json
import shutil
from dataclasses import replace
from importlib.metadata import version

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap.writer import Writer
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.detour import Detour
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import BROKEN_OFF
from shared_control_learning.evaluation.evaluate import Evaluation
from shared_control_records.bag.task import RECORD
from shared_control_records.session import bag_metadata, picture, report
from shared_control_records.session.bag_report import write_bag_report
from shared_control_records.session.episodes import EpisodeRow, read_episodes, write_episodes
from shared_control_records.session.final_test import load_test, save_test
from shared_control_records.session.folder import SessionFolder
from shared_control_records.session.report import write_report
from shared_control_testing import sessions as made

PNG = b'\x89PNG'


def evaluation():
    """19 good episodes and one in which the ball fell."""
    good = Episode(BALANCE, 1, 'test', position_error=(0.15 * np.exp(-np.arange(500) / 50)).tolist(),
                   velocity=[0.0] * 500)
    bad = Episode(BALANCE, 1, 'test', position_error=np.linspace(0.1, 0.3, 80).tolist(), velocity=[1.0] * 80,
                  failed=True)
    return Evaluation((good,) * 19 + (bad,))


@pytest.fixture
def no_picture(monkeypatch):
    """Drawing takes a second."""
    monkeypatch.setattr(report, 'draw_picture', lambda path, *_: path.write_bytes(PNG) and [])


@pytest.fixture(scope='module')
def lessons():
    lessons = [made.lesson(50, seed=seed) for seed in range(3)]
    lessons[1].fallen = True
    return lessons


@pytest.fixture(scope='module')
def bag(lessons, tmp_path_factory):
    return made.record(lessons).write(tmp_path_factory.mktemp('made') / 'bag')


@pytest.fixture
def folder(lessons, bag, tmp_path):
    folder = SessionFolder.create(tmp_path / 'session')
    shutil.copytree(bag, folder.bag)
    made.write_episodes(folder.episodes, lessons)
    made.write_settings(folder.settings)
    save_test(evaluation(), folder.test)
    return folder


@pytest.mark.usefixtures('no_picture')
def test_the_summary_has_the_figures(folder):
    write_report(folder, restarts=1)
    summary = json.loads(folder.summary.read_text())
    assert summary == {
        'task': 'balance', 'preset': 'coached', 'seed': 0, 'recorded': '2026-11-22T13:30:00Z',
        'tutor': 'simulated: expert', 'simulated_tutor': True,
        'duration_s': 3.0, 'episodes_taught': 3, 'episodes_discarded': 0, 'episodes_broken_off': 0,
        'taught_s': 3.0, 'key_presses': 15, 'devices': ['keys (tutor)'],
        'autonomous_success': 19, 'autonomous_episodes': 20,
        'control_rate_hz': pytest.approx(999.0), 'real_time_factor': pytest.approx(0.999),
        'tick_ms': {'p50': 0.61, 'p99': 0.93}, 'late_tick_ratio': 0.01, 'restarts': 1, 'bag_checks': [],
        'bag': 'bag', 'picture': 'picture.png', 'report': 'report.html'}


def test_the_report_says_what_matters_and_needs_no_other_file(folder):
    write_report(folder)
    page = folder.report.read_text()
    assert page.index('The tutor was simulated') < page.index('What was done')
    assert '19 of 20 randomised episodes succeeded' in page
    assert 'Checked and found whole' in page
    assert 'ros2 bag play bag' in page
    assert 'src="data:image/png;base64,' in page
    assert 'http' not in page
    assert str(folder.path) not in page + folder.summary.read_text(), 'it is passed on'
    assert folder.picture.read_bytes().startswith(PNG)
    assert folder.picture.with_suffix('.pdf').read_bytes()[:4] == b'%PDF'
    assert 'shared-control' in folder.picture.with_suffix('.svg').read_text()
    assert page.count('<figcaption>') == page.count('src="data:image/png;base64,') == 6
    assert f'shared-control {version("shared-control")} · seed 0 · 2026-11-22 · recorded' in page


@pytest.mark.parametrize(('tutor', 'said'), [
    ('keyboard', 'Taught by a person'),
    ('none', 'Nobody was to teach, but somebody pressed keys or pushed. In the hand'),
    ('<b>', 'Taught by a person (&lt;b&gt;)')])
@pytest.mark.usefixtures('no_picture')
def test_who_taught(folder, tutor, said):
    made.write_settings(folder.settings, tutor)
    assert write_report(folder).simulated_tutor is False
    page = folder.report.read_text()
    assert said in page
    assert 'The tutor was simulated' not in page


@pytest.mark.parametrize(('presses', 'share', 'alone'), [
    (0, 0.0, True), (None, None, True), (3, 0.0, False), (0, 0.1, False)])
@pytest.mark.usefixtures('no_picture')
def test_nobody_pressed_where_nobody_pressed_nor_pushed(folder, presses, share, alone):
    summary = replace(write_report(folder), tutor='none', simulated_tutor=False, key_presses=presses, devices=[])
    page = report.render_page(summary, [EpisodeRow(1, 'teach', 3.0, -1.0, False, share)], None, [])
    assert ('Nobody pressed keys.' in page, 'Nobody taught' in page) == (alone, alone)
    assert ('Nobody was to teach' in page) != alone


@pytest.mark.usefixtures('no_picture')
def test_writing_it_again_keeps_what_only_the_session_knew(folder):
    write_report(folder, restarts=2)
    assert write_report(folder).restarts == 2


def test_an_empty_folder_gives_a_report_full_of_gaps(tmp_path):
    folder = SessionFolder.create(tmp_path / 'session')
    summary = write_report(folder).as_dict()
    assert {name for name, value in summary.items() if value is not None} == {'task', 'picture', 'report'}
    page = folder.report.read_text()
    assert 'It is not known who taught' in page
    assert 'Not tested' in page
    assert 'There is no bag' in page
    assert folder.picture.read_bytes().startswith(PNG)


@pytest.mark.usefixtures('no_picture')
def test_a_bag_that_cannot_be_read_is_reported(folder):
    (folder.bag / 'metadata.yaml').unlink()
    summary = write_report(folder)
    assert len(summary.bag_checks) == 1
    assert 'was not finished' in summary.bag_checks[0]
    assert summary.key_presses is None
    assert summary.autonomous_success == 19
    assert str(folder.path) not in folder.report.read_text() + folder.summary.read_text()


def test_a_test_is_kept_and_read_back(tmp_path):
    saved = save_test(evaluation(), tmp_path / 'test.json')
    assert load_test(tmp_path / 'test.json') == saved
    assert json.loads((tmp_path / 'test.json').read_text())['successes'] == 19
    assert saved.successes == 19
    assert not saved.episodes[-1].kept
    assert saved.episodes[0].ball_start == pytest.approx(0.15)
    assert len(saved.episodes[0].track) == 100
    assert load_test(tmp_path / 'none.json') is None


def annotated(bag, path, content):
    """Copy a bag's file and put a session's record into the copy."""
    with bag.open('rb') as source, path.open('wb') as target:
        writer = Writer(target)
        writer.start(profile='ros2')
        reader = make_reader(source)
        summary = reader.get_summary()
        kinds = {schema.id: writer.register_schema(schema.name, schema.encoding, schema.data)
                 for schema in summary.schemas.values()}
        channels = {channel.id: writer.register_channel(
            channel.topic, channel.message_encoding, kinds[channel.schema_id], channel.metadata)
            for channel in summary.channels.values()}
        for _, channel, message in reader.iter_messages():
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
        writer.add_metadata(RECORD, content)
        writer.finish()


@pytest.mark.usefixtures('no_picture')
def test_a_simulated_tutor_of_an_earlier_part_is_not_forgotten(folder):
    folder.write_settings({'preset': 'coached', 'tutor': 'keyboard', 'earlier_tutors': ['simulated: low']})
    summary = write_report(folder)
    assert summary.simulated_tutor is True
    assert summary.tutor == 'keyboard, before that simulated: low'
    assert 'The tutor was simulated' in folder.report.read_text()


def test_the_bag_alone_gives_the_same_report(folder, tmp_path):
    original = write_report(folder, restarts=1)
    annotated(next(folder.bag.glob('*.mcap')), tmp_path / 'session.mcap', bag_metadata.pack(folder, restarts=1))
    shutil.rmtree(folder.path)
    page = write_bag_report(tmp_path / 'session.mcap', tmp_path / 'again')
    again = json.loads((page.parent / 'summary.json').read_text())
    places = ('bag', 'picture', 'report')
    assert {**again, **dict.fromkeys(places)} == {**original.as_dict(), **dict.fromkeys(places)}
    assert '19 of 20 randomised episodes succeeded' in page.read_text() and str(tmp_path) not in page.read_text()
    assert (page.parent / 'picture.png').read_bytes().startswith(PNG)


@pytest.mark.usefixtures('no_picture')
@pytest.mark.parametrize(('name', 'content', 'message'), [
    ('settings.json', '{"preset": 5}', r'settings\.json: preset: .*found 5'),
    ('settings.json', '{"tutor": "keyboard", "earlier_tutors": null}', r'settings\.json: earlier_tutors'),
    ('settings.json', '{"tutor": ["keyboard"]}', r'settings\.json: tutor'),
    ('settings.json', '{', r'settings\.json'),
    ('summary.json', '{"restarts": "often"}', r'summary\.json: restarts'),
    ('parameters.yaml', 'torque_ctrl_node: {ros__parameters: {moment_limit: much}}', r'parameters\.yaml: moment_limit'),
    ('test.json', '{}', r'test\.json'),
    ('learner/episodes.csv', 'episode,phase\nx,teach\n', r'episodes\.csv, line 2')])
def test_a_damaged_record_of_a_session_is_named_and_leaves_nothing(folder, tmp_path, name, content, message):
    theirs = tmp_path / 'theirs.mcap'
    annotated(next(folder.bag.glob('*.mcap')), theirs, bag_metadata.pack(folder, restarts=1) | {name: content})
    with pytest.raises(ValueError, match=message) as error:
        write_bag_report(theirs, tmp_path / 'again')
    assert str(theirs) in str(error.value)
    assert not (tmp_path / 'again').exists()


@pytest.mark.usefixtures('no_picture')
def test_an_interrupted_report_of_a_bag_is_not_in_the_way_of_the_next(bag, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr('shared_control_records.session.bag_report.write_report', interrupted)
        with pytest.raises(KeyboardInterrupt):
            write_bag_report(bag, tmp_path / 'again')
    assert write_bag_report(bag, tmp_path / 'again').exists()


def interrupted(*_, **__):
    raise KeyboardInterrupt


@pytest.mark.usefixtures('no_picture')
def test_a_bag_of_a_session_that_was_killed_tells_what_its_topics_do(bag, lessons, tmp_path):
    page = write_bag_report(bag, tmp_path / 'again')
    assert 'The tutor was simulated' in page.read_text()
    rows = read_episodes(page.parent / 'learner' / 'episodes.csv')
    assert [(row.number, row.episode_return) for row in rows] == [(1, -100.0), (2, -100.0), (3, -100.0)]
    with pytest.raises(OSError, match='already holds a session'):
        write_bag_report(bag, tmp_path / 'again')


def test_damaged_tables_are_named(tmp_path):
    (tmp_path / 'test.json').write_text('{"episodes": [{"success": true}]}')
    with pytest.raises(ValueError, match=r'test\.json'):
        load_test(tmp_path / 'test.json')
    (tmp_path / 'episodes.csv').write_text('episode,phase\n1,teach\nx,teach\n')
    with pytest.raises(ValueError, match=r'episodes.csv, line 3'):
        read_episodes(tmp_path / 'episodes.csv')
    (tmp_path / 'episodes.csv').write_text('episode,phase,seconds\n1,teach,nan\n')
    with pytest.raises(ValueError, match=r'episodes.csv, line 2.*seconds is nan'):
        read_episodes(tmp_path / 'episodes.csv')
    assert read_episodes(tmp_path / 'none.csv') == []


def test_columns_are_found_by_name(tmp_path):
    (tmp_path / 'episodes.csv').write_text('phase,extra,human_share,episode,return,fallen\ntest,7,0.25,4,-3.5,1\n')
    row, = read_episodes(tmp_path / 'episodes.csv')
    assert (row.number, row.phase, row.human_share, row.episode_return, row.fallen) == (4, 'test', 0.25, -3.5, True)
    assert row.seconds is None


def test_what_is_packed_into_a_bag_names_no_home_and_no_token(tmp_path):
    """Bags are handed to others."""
    folder = SessionFolder.create(tmp_path / 'home' / 'jane.doe' / 'session')
    folder.parameters.write_text(yaml.safe_dump({'/**/teach_page_node': {'ros__parameters': {
        'token': 's3cret', 'output': str(folder.bag), 'robot': '/home/jane.doe/robots/ur5.yaml', 'rate': 50.0,
        'files': [str(folder.learner), '~jane.doe/a.yaml'], 'name': 'a/b'}}}))
    folder.write_settings({'task': 'balance', 'robot': '/home/jane.doe/robots/ur5.yaml', 'earlier_tutors': []})
    packed = bag_metadata.pack(folder, restarts=0)
    assert json.loads(packed['settings.json']) == {'task': 'balance', 'robot': 'ur5.yaml', 'earlier_tutors': []}
    assert yaml.safe_load(packed['parameters.yaml']) == {'/**/teach_page_node': {'ros__parameters': {
        'output': 'bag', 'robot': 'ur5.yaml', 'rate': 50.0, 'files': ['learner', 'a.yaml'], 'name': 'a/b'}}}
    assert 'jane.doe' not in str(packed) and 's3cret' not in str(packed)
    folder.parameters.write_text('{')
    folder.settings.write_text('{')
    assert not {'parameters.yaml', 'settings.json'} & bag_metadata.pack(folder, restarts=0).keys()


def test_a_session_with_two_axes_is_reported_from_above(tmp_path, lessons, bag, monkeypatch):
    drawn = []
    monkeypatch.setattr(picture, 'draw_track', lambda axes, scene, track, *_: drawn.append((scene, track)))
    folder = SessionFolder.create(tmp_path / 'session', settings={'preset': 'coached_network', 'task': 'detour'})
    shutil.copytree(bag, folder.bag)
    made.write_episodes(folder.episodes, lessons)
    task = Detour()
    way = np.linspace((-0.05, -0.08), task.scene.goal, 750)
    episode = Episode(task, 1, 'test', position_error=[0.01] * 750, velocity=[0.0] * 750, on_tray=way.tolist())
    save_test(Evaluation((episode,) * 20), folder.test)
    summary = write_report(folder)
    assert (summary.task, summary.autonomous_success) == ('detour', 20)
    assert folder.picture.read_bytes().startswith(PNG)
    taught, alone = drawn[:3], drawn[3:]
    assert len(alone) == 20 and {scene.goal for scene, _ in drawn} == {task.scene.goal}
    np.testing.assert_allclose(alone[0][1][0], (-0.05, -0.08))
    for (_, track), lesson in zip(taught, lessons, strict=True):
        assert np.ptp(track[:, 0]) == pytest.approx(np.ptp(lesson.position_error), abs=0.01)
    assert 'under 3 cm' in folder.report.read_text(), 'the radius of the goal of this task'


@pytest.mark.parametrize('step_s', [-1, 3 * 10**8])
def test_the_robots_time_was_set_between_episodes(tmp_path, step_s):
    """By a simulator that was started anew after somebody had set the clock: back, or forward from 1970."""
    lessons = [made.lesson(50, seed=seed) for seed in (1, 2)]
    first = made.record(lessons[:1])
    later = made.record(lessons[1:], start_ns=made.START_NS + step_s * 10**9)
    shift = 3 * 10**9 - step_s * 10**9  # the recorder's clock was right all the while
    recording = made.Recording([
        *first.messages, *((topic, at + shift, content) for topic, at, content in later.messages)])
    folder = SessionFolder.create(tmp_path / 'session')
    recording.write(folder.bag)
    made.write_episodes(folder.episodes, lessons)
    made.write_settings(folder.settings)
    write_report(folder)
    assert folder.picture.read_bytes().startswith(PNG)


@pytest.mark.usefixtures('no_picture')
def test_why_an_episode_was_broken_off_is_said(folder):
    rows = read_episodes(folder.episodes)
    write_episodes([EpisodeRow(1, BROKEN_OFF, 4.0, None, None, None, reason='the person starts it over'), *rows],
                   folder.episodes)
    write_report(folder)
    assert 'Episode 1 was broken off after 4.0 s: the person starts it over.' in folder.report.read_text()
