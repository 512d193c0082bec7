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

"""The folder of a session: made, found again, kept from harm."""

import json
import subprocess
import sys

import pytest
from shared_control.run_folder import RunFolderError
from shared_control_learning.episode_table import TABLE_NAME, UNFINISHED_NAME
from shared_control_learning.policy_file import POLICY_NAME
from shared_control_learning.practice import PRACTICE_NAME
from shared_control_records.session.folder import SessionFolder


def finished(path):
    """A folder that another session has left."""
    folder = SessionFolder.create(path)
    folder.write_settings({'tutor': 'keyboard'})
    folder.report.write_text('old')
    folder.bag.mkdir()
    folder.release()
    return folder


def test_a_new_folder_has_room_for_learner_and_logs(tmp_path):
    folder = SessionFolder.create(tmp_path / 'out' / 'one')
    assert folder.learner.is_dir()
    assert folder.logs.is_dir()
    assert folder.episodes == tmp_path / 'out' / 'one' / 'learner' / 'episodes.csv'


def test_an_earlier_session_is_kept_unless_told_otherwise(tmp_path):
    finished(tmp_path)
    with pytest.raises(RunFolderError, match='already holds a session'):
        SessionFolder.create(tmp_path)
    assert (tmp_path / 'report.html').read_text() == 'old'
    (tmp_path / 'notes.txt').write_text('mine')
    folder = SessionFolder.create(tmp_path, overwrite=True)
    assert not folder.report.exists()
    assert not folder.bag.exists()
    assert (tmp_path / 'notes.txt').read_text() == 'mine'


def test_a_folder_that_is_left_half_made_is_a_session(tmp_path):
    (tmp_path / 'session').mkdir()
    SessionFolder.create(tmp_path / 'session', settings={'tutor': 'keyboard'}).release()
    assert SessionFolder.open(tmp_path / 'session').holds_run
    SessionFolder.create(tmp_path / 'session', overwrite=True)


def test_what_is_no_session_is_never_overwritten(tmp_path):
    (tmp_path / 'thesis.tex').write_text('years of work')
    with pytest.raises(RunFolderError, match='no session'):
        SessionFolder.create(tmp_path, overwrite=True)
    assert [child.name for child in tmp_path.iterdir()] == ['thesis.tex']


def test_a_project_with_settings_of_its_own_is_no_session(tmp_path):
    for name in ('settings.json', 'report.html', 'log/mine.txt', 'learner/notes.txt', 'bag/bag_0.mcap'):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text('{"editor.fontSize": 12}')
    before = sorted(tmp_path.rglob('*'))
    with pytest.raises(RunFolderError, match='not empty and no session'):
        SessionFolder.create(tmp_path, overwrite=True)
    assert sorted(tmp_path.rglob('*')) == before
    for path in sorted((tmp_path / 'bag').iterdir()) + [tmp_path / 'bag']:
        path.rmdir() if path.is_dir() else path.unlink()
    with pytest.raises(RunFolderError, match='is no session folder'):
        SessionFolder.open(tmp_path)


def test_files_that_somebody_put_into_a_session_outlive_it(tmp_path):
    folder = finished(tmp_path)
    for name in (POLICY_NAME, TABLE_NAME, UNFINISHED_NAME, PRACTICE_NAME, '.lock'):
        (folder.learner / name).write_text('old')
    (folder.logs / 'torque_ctrl_node.log').write_text('old')
    (folder.bag / 'bag_0.mcap').write_text('old')
    mine = [inner / 'mine.txt' for inner in (folder.bag, folder.learner, folder.logs)]
    for path in mine:
        path.write_text('mine')
    new = SessionFolder.create(tmp_path, overwrite=True)
    assert sorted(path for path in tmp_path.rglob('*') if path.is_file() and path != tmp_path / '.lock') == sorted(mine)
    assert new.learner.is_dir() and new.logs.is_dir()


def test_a_file_in_the_way(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(RunFolderError, match=r'cannot write the session folder .*file'):
        SessionFolder.create(tmp_path / 'file' / 'session')


def test_one_session_at_a_time(tmp_path):
    holder = subprocess.Popen(
        [sys.executable, '-c', 'import sys; from shared_control_records.session.folder import SessionFolder\n'
         'folder = SessionFolder.create(sys.argv[1]); print("held", flush=True); sys.stdin.read()', tmp_path],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert holder.stdout.readline() == b'held\n'
    with pytest.raises(RunFolderError, match='in use by another session'):
        SessionFolder.create(tmp_path, overwrite=True)
    holder.kill()
    holder.communicate()
    SessionFolder(tmp_path).claim()  # whoever was killed no longer holds it


def test_opening_an_earlier_session(tmp_path):
    path = finished(tmp_path).path
    SessionFolder.open(path).claim()
    with pytest.raises(RunFolderError, match='there is no session folder'):
        SessionFolder.open(path / 'nowhere')
    with pytest.raises(RunFolderError, match=r'neither .*settings\.json nor bag'):
        SessionFolder.open(path / 'learner')


def test_files_of_a_folder(tmp_path):
    folder = SessionFolder(tmp_path)
    assert folder.read_json(folder.settings) is None
    assert folder.ros_parameters('torque_ctrl_node') == {}
    folder.settings.write_text(json.dumps({'preset': 'coached'}))
    folder.parameters.write_text('torque_ctrl_node:\n  ros__parameters:\n    moment_limit: 12.5\n')
    assert folder.read_json(folder.settings) == {'preset': 'coached'}
    assert folder.ros_parameters('torque_ctrl_node') == {'moment_limit': 12.5}
    assert folder.ros_parameters('other_node') == {}
    folder.settings.write_text('{"preset": ')
    folder.parameters.write_text('- 1')
    with pytest.raises(RunFolderError, match=r'settings\.json'):
        folder.read_json(folder.settings)
    with pytest.raises(RunFolderError, match=r'parameters\.yaml'):
        folder.ros_parameters('torque_ctrl_node')
