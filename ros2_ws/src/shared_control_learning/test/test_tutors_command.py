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

"""``shared-control tutors``: who does the task alone how well, with keys and with a stick."""

import json

import pytest
from shared_control.cli import main
from shared_control.teaching.families import FAMILIES


@pytest.fixture
def tutors(monkeypatch, tmp_path):
    """``tutors(*arguments)``: the exit code, and what it writes as JSON, by name."""
    def run(*arguments):
        file = tmp_path / 'tutors.json'
        command = ['shared-control', 'tutors', '--individuals', '1', '--json', str(file), *arguments]
        monkeypatch.setattr('sys.argv', command)
        if code := main():
            return code, {}
        return code, {row['tutor']: row for row in json.loads(file.read_text())['tutors']}
    return run


def test_with_keys_they_press_and_with_a_stick_they_hold(tutors, capsys):
    for device in ('keys', 'stick'):
        code, rows = tutors('reactive', '--device', device)
        assert code == 0 and rows['reactive']['device'] == device
        assert (rows['reactive']['presses_a_minute'] is None) is (device == 'stick')
        assert 0.1 < rows['reactive']['intervention_rate'] <= 1.0
    assert 'with a stick' in capsys.readouterr().out


def test_all_who_can_have_a_stick_are_measured_and_others_are_refused_by_name(tutors, monkeypatch, capsys):
    monkeypatch.setattr('shared_control_learning.tutors_command.alone', lambda name, *_: {
        'tutor': name, 'use': '', 'success': 0.0, 'kept': 0.0, 'position_error': 0.0, 'intervention_rate': 0.0,
        'presses_a_minute': None, 'source': ''})
    code, rows = tutors('--device', 'stick')
    assert code == 0 and set(rows) == set(FAMILIES) - {'predictive'}
    assert tutors('expert', '--device', 'stick')[0] == 2
    assert 'know keys alone' in capsys.readouterr().err
