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

"""Files on file systems that lack something, and output that nobody reads any more."""

import argparse
import errno
import fcntl
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from shared_control.command_line import add_json_option, write_json
from shared_control.files import lock, refuse_another_file, refuse_unwritable, write_atomically

LATE = """
import sys, time
from shared_control.streams import lossy_output
with lossy_output():
    print('first', flush=True)
    sys.stdin.readline()
    print('nobody reads this', flush=True)
    print('nor this')
    print('nor that', file=sys.stderr)
open(sys.argv[1], 'w').write('the work is done')
"""


def test_a_file_is_written_where_modes_cannot_be_set(tmp_path, monkeypatch):
    def no_modes(*_args, **_options):
        raise PermissionError(errno.EPERM, 'Operation not permitted')

    monkeypatch.setattr(Path, 'chmod', no_modes)
    write_atomically(tmp_path / 'file', b'content')
    assert (tmp_path / 'file').read_bytes() == b'content' and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize('there', [None, b'', b'{"protocol": "randomized"}', b'notes of somebody'])
def test_json_is_written_over_nothing_but_json(tmp_path, capsys, there):
    path = tmp_path / 'file'
    if there is not None:
        path.write_bytes(there)
    parser = argparse.ArgumentParser()
    add_json_option(parser, 'figures')
    if there != b'notes of somebody':
        write_json({'figure': 1}, parser.parse_args(['--json', str(path)]).json)
        assert json.loads(path.read_text()) == {'figure': 1}
        return
    with pytest.raises(SystemExit):
        parser.parse_args(['--json', str(path)])
    assert f'{path} exists already and is no JSON file' in capsys.readouterr().err and path.read_bytes() == there


def test_a_place_that_cannot_be_written_is_refused_before_the_work(tmp_path):
    refuse_unwritable(tmp_path / 'new' / 'newer')
    (tmp_path / 'notes').touch()
    (tmp_path / 'dangling').symlink_to(tmp_path / 'nowhere')
    for folder in (tmp_path / 'notes', tmp_path / 'notes' / 'new', tmp_path / 'dangling'):
        with pytest.raises(NotADirectoryError, match=f'cannot write to {folder}'):
            refuse_unwritable(folder)
        with pytest.raises(NotADirectoryError, match=f'cannot write to {folder}'):
            refuse_another_file(folder / 'x.json', 'JSON file', b'{')
    assert sorted(path.name for path in tmp_path.iterdir()) == ['dangling', 'notes']


@pytest.mark.parametrize('number', [errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_file_system_without_locks_is_known_for_it(tmp_path, monkeypatch, number):
    with (tmp_path / 'file').open('wb') as file, (tmp_path / 'file').open('wb') as other:
        assert lock(file)
        with pytest.raises(BlockingIOError):
            lock(other)

        def no_locks(*_):
            raise OSError(number, 'no locks here')

        monkeypatch.setattr(fcntl, 'flock', no_locks)
        assert not lock(other)


@pytest.mark.parametrize('lost', ['stdout', 'stderr'])
def test_a_lost_reader_costs_no_work(tmp_path, lost):
    pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE}
    command = subprocess.Popen([sys.executable, '-c', LATE, tmp_path / 'done'], stdin=subprocess.PIPE, **pipes)
    assert command.stdout.readline() == b'first\n'
    getattr(command, lost).close()
    command.stdin.write(b'\n')
    command.stdin.close()
    assert command.wait(60) == 0
    assert (tmp_path / 'done').read_text() == 'the work is done'


FULL = """
from shared_control import cli
cli._run = lambda: print('figures') or 0
raise SystemExit(cli.main())
"""


@pytest.mark.parametrize(('streams', 'said'), [
    ('> /dev/full', 'shared-control: standard output is not complete: No space left on device\n'), ('2> /dev/full', ''),
    ('> /dev/full 2>&1', '')])
def test_output_to_a_full_disk_is_an_error(streams, said):
    done = subprocess.run(['sh', '-c', f'exec "$0" -c "$1" {streams}', sys.executable, FULL], capture_output=True,
                          text=True, check=False)
    assert (done.returncode, done.stderr) == (2 if streams.startswith('>') else 0, said)


def test_a_file_that_cannot_be_written_is_named_and_a_device_stays_one(tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(errno.ENOSPC, 'No space left on device')

    (tmp_path / 'file').write_text('before')
    with monkeypatch.context() as patch:
        patch.setattr('os.fsync', full)
        with pytest.raises(OSError, match=f"No space left on device: '{tmp_path}/file'"):
            write_atomically(tmp_path / 'file', b'content')
    assert [path.read_text() for path in tmp_path.iterdir()] == ['before']
    write_atomically(Path('/dev/null'), b'content')
    assert Path('/dev/null').is_char_device()
    os.mkfifo(tmp_path / 'pipe')
    with subprocess.Popen(['cat', tmp_path / 'pipe'], stdout=subprocess.PIPE) as reader:
        write_atomically(tmp_path / 'pipe', b'content')
        assert reader.communicate()[0] == b'content'


CLOSED = """
import os, sys
from shared_control.streams import lossy_output, open_closed_streams
open_closed_streams()
with open(sys.argv[1], 'w') as file, lossy_output():
    print('to nobody', flush=True)
    print('nor to anybody', file=sys.stderr, flush=True)
    subprocess = os.system('echo from a child; echo of this; cat')
    file.write(f'{sys.stdin.isatty()} {sys.stdin.read()!r} {subprocess}')
"""


@pytest.mark.parametrize('closed', ['<&-', '>&-', '2>&-', '<&- >&- 2>&-'])
def test_a_stream_that_is_closed_is_one_to_nobody(tmp_path, closed):
    done = subprocess.run(['sh', '-c', f'exec "$0" -c "$1" "$2" {closed}', sys.executable, CLOSED, tmp_path / 'file'],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and 'Error' not in done.stderr
    assert (tmp_path / 'file').read_text() == "False '' 0"
