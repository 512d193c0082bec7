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

"""The folder of a run: whose it is, and what in it may go."""

import errno
import fcntl

import pytest
from shared_control.run_folder import RunFolder, RunFolderError


@pytest.fixture
def folder(tmp_path):
    """A folder that an earlier run has left, with a stranger's file in it."""
    path = tmp_path / 'run'
    (path / 'logs').mkdir(parents=True)
    (path / 'logs' / 'old.txt').write_text('old')
    (path / 'run.json').write_text('{"seed": 1}')
    (path / 'notes.txt').write_text('mine')
    return path


def run_in(path):
    return RunFolder(path, 'run', own=('logs/*.txt', 'report.html'), mark='run.json', keys=['seed'])


def test_only_what_a_run_writes_is_removed(folder):
    run_in(folder).begin(overwrite=True)
    assert sorted(child.name for child in folder.iterdir()) == ['.lock', 'notes.txt']


@pytest.mark.parametrize('content', ['{"editor.fontSize": 12}', '["seed"]', '{', '', '[' * 3000])
def test_a_file_of_the_same_name_is_no_run(folder, content):
    (folder / 'run.json').write_text(content)
    with pytest.raises(RunFolderError, match='not empty and no run'):
        run_in(folder).begin(overwrite=True)
    assert (folder / 'run.json').read_text() == content and (folder / 'logs' / 'old.txt').exists()


def test_files_of_others_within_the_folders_of_a_run_stay(folder):
    (folder / 'logs' / 'mine.pdf').write_text('mine')
    (folder / 'logs' / 'mine.txt').mkdir()
    run_in(folder).begin(overwrite=True)
    assert sorted(child.name for child in (folder / 'logs').iterdir()) == ['mine.pdf', 'mine.txt']
    assert not (folder / 'run.json').exists()


def test_a_run_that_came_to_nothing_leaves_nothing(folder, tmp_path):
    new = run_in(tmp_path / 'new')
    new.begin()
    (tmp_path / 'new' / 'run.json').write_text('{}')
    new.discard()
    assert not (tmp_path / 'new').exists()
    run_in(folder).discard()
    assert [child.name for child in folder.iterdir()] == ['notes.txt']


def test_a_link_is_removed_and_not_what_it_leads_to(folder, tmp_path):
    (tmp_path / 'elsewhere').mkdir()
    (folder / 'logs' / 'old.txt').unlink()
    (folder / 'logs').rmdir()
    (folder / 'logs').symlink_to(tmp_path / 'elsewhere')
    run_in(folder).begin(overwrite=True)
    assert (tmp_path / 'elsewhere').is_dir() and not (folder / 'logs').exists()


def test_a_refused_beginning_leaves_everything_as_it_was(folder):
    before = sorted(folder.rglob('*'))
    with pytest.raises(RunFolderError, match='already holds a run'):
        run_in(folder).begin()
    assert sorted(folder.rglob('*')) == before
    (folder / 'run.json').unlink()
    with pytest.raises(RunFolderError, match='not empty and no run'):
        run_in(folder).begin(overwrite=True)
    assert (folder / 'logs' / 'old.txt').read_text() == 'old'


def test_one_writer_at_a_time(folder):
    first = run_in(folder)
    first.claim()
    for second in (lambda: run_in(folder).claim(), lambda: run_in(folder).begin(overwrite=True)):
        with pytest.raises(RunFolderError, match='in use by another run'):
            second()
    assert (folder / 'run.json').exists()
    first.release()
    run_in(folder).claim()


def test_a_file_system_without_locks_is_told_of_and_used(folder, monkeypatch, caplog):
    def no_locks(*_):
        raise OSError(errno.ENOLCK, 'No locks available')

    monkeypatch.setattr(fcntl, 'flock', no_locks)
    run_in(folder).begin(overwrite=True)
    assert 'without locks' in caplog.text and str(folder) in caplog.text
