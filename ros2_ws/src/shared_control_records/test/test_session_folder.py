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
from shared_control_records.session.folder import SessionFolder


def finished(path):
    """A folder that another session has left."""
    folder = SessionFolder.create(path)
    folder.settings.write_text('{}')
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
    SessionFolder.create(tmp_path / 'session', settings={'preset': 'coached'}).release()
    assert SessionFolder.open(tmp_path / 'session').holds_run
    SessionFolder.create(tmp_path / 'session', overwrite=True)


def test_what_is_no_session_is_never_overwritten(tmp_path):
    (tmp_path / 'thesis.tex').write_text('years of work')
    with pytest.raises(RunFolderError, match='no session'):
        SessionFolder.create(tmp_path, overwrite=True)
    assert [child.name for child in tmp_path.iterdir()] == ['thesis.tex']


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
    with pytest.raises(RunFolderError, match=r'neither settings\.json nor bag'):
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
