"""What ``tools/slim_environment.py`` leaves works, and pip takes it as it is: uninstalls it, or brings it back."""

import base64
import csv
import hashlib
import io
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / 'tools' / 'slim_environment.py'
HEADER, MODULE = 'cmeel.prefix/include/some/header.hpp', 'some.py'
ALIASES = ('cmeel.prefix/lib/libsome.so', 'cmeel.prefix/lib/libsome.so.1', 'cmeel.prefix/lib/libsome.so.1.2')
OTHER, ELSEWHERE = 'cmeel.prefix/lib/libother.so', 'elsewhere/libsome.so'
LIBRARY = b'\x7fELF' + bytes(range(256)) * 100


def make_wheel(folder):
    """A wheel with a header, a library under three names, an equal one elsewhere, and one of the same size."""
    files = {MODULE: b'answer = 42\n', HEADER: b'#pragma once\n', **dict.fromkeys(ALIASES, LIBRARY),
             ELSEWHERE: LIBRARY, OTHER: LIBRARY[::-1],
             'some-1.0.dist-info/METADATA': b'Metadata-Version: 2.1\nName: some\nVersion: 1.0\n',
             'some-1.0.dist-info/WHEEL': (b'Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: false\n'
                                         b'Tag: py3-none-any\n')}
    record = io.StringIO()
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip('=')
        csv.writer(record, lineterminator='\n').writerow((name, f'sha256={digest}', len(content)))
    record.write('some-1.0.dist-info/RECORD,,\n')
    path = folder / 'some-1.0-py3-none-any.whl'
    with zipfile.ZipFile(path, 'w') as archive:
        for name, content in {**files, 'some-1.0.dist-info/RECORD': record.getvalue()}.items():
            archive.writestr(name, content)
    return path


@pytest.fixture
def environment(tmp_path):
    """An environment with that wheel in it: its interpreter, its packages, the wheel."""
    venv.create(tmp_path / 'venv', with_pip=False)
    packages = next((tmp_path / 'venv').glob('lib/python*/site-packages'))
    wheel = make_wheel(tmp_path)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(packages)
    return tmp_path / 'venv' / 'bin' / 'python', packages, wheel


def slim(python):
    return subprocess.run([python, SCRIPT], check=True, capture_output=True, text=True, timeout=60).stdout


def test_headers_go_and_a_library_is_one_file_under_all_its_names(environment):
    python, packages, _ = environment
    assert 'MB of headers removed' in slim(python)
    assert not (packages / 'cmeel.prefix' / 'include').exists()
    first, *others = (packages / name for name in ALIASES)
    assert all(path.samefile(first) and not path.is_symlink() for path in others)
    assert not first.samefile(packages / ELSEWHERE)
    assert {path.read_bytes() for path in (first, *others, packages / ELSEWHERE)} == {LIBRARY}
    assert (packages / OTHER).read_bytes() == LIBRARY[::-1]
    assert subprocess.run([python, '-c', 'import some; print(some.answer)'], check=True, capture_output=True,
                          text=True).stdout == '42\n'
    left = {path: path.stat().st_ino for path in packages.rglob('*') if '__pycache__' not in path.parts}
    slim(python)
    assert {path: path.stat().st_ino for path in left} == left and not list(packages.rglob('*.linked'))


def test_pip_uninstalls_and_brings_back_what_was_made_smaller(environment):
    python, packages, wheel = environment

    def pip(*words):
        said = subprocess.run([sys.executable, '-m', 'pip', '--python', python, '--disable-pip-version-check', *words],
                              capture_output=True, text=True, check=False, timeout=300)
        assert said.returncode == 0, said.stdout + said.stderr

    slim(python)
    pip('check')
    pip('install', '--no-index', '--force-reinstall', wheel)
    assert (packages / HEADER).is_file()
    assert all((packages / name).read_bytes() == LIBRARY for name in ALIASES)
    assert not (packages / ALIASES[0]).samefile(packages / ALIASES[1])
    slim(python)
    pip('uninstall', '--yes', 'some')
    assert not [path for path in packages.rglob('*') if path.is_file()]


def test_who_asks_for_help_changes_nothing(environment):
    python, packages, *_ = environment
    said = subprocess.run([python, SCRIPT, '--help'], check=False, capture_output=True, text=True, timeout=60)
    assert 'hard links' in said.stderr and (packages / HEADER).is_file()
