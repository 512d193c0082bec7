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

"""``shared-control doctor`` on a healthy machine, and on machines that were made sick for real."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from shared_control_testing import machines
from shared_control_testing.machines import DOMAIN, HEALTHY, NO_BROWSER, NO_REAL_TIME, SHARED_MEMORY, VARIABLES

PAGE = Path(__file__).parents[4] / 'docs' / 'reference' / 'doctor.md'


def examine(machine=HEALTHY):
    """Exit code and lines of the doctor on a machine."""
    code, output = machines.examine(machine, dict(os.environ))
    return code, output.splitlines()


def is_shown(machine, lines):
    """Whether the page shows what was found on the machine, whatever the figures."""
    said = '\n'.join(machines.wrong('\n'.join(lines)))
    section = f'## {machine.title}\n\n{machine.done} Exit code 0.\n\n```text\n{said}\n```\n'
    return re.sub(r'\d+', 'N', section) in re.sub(r'\d+', 'N', PAGE.read_text())


def line_of(lines, subject):
    """Level and text of what was found of a subject, and the remedy below it."""
    [number] = [number for number, line in enumerate(lines) if line[7:].startswith(subject)]
    remedy = lines[number + 1].strip() if lines[number + 1].startswith(' ' * 9) else ''
    return lines[number].split(maxsplit=1)[0], lines[number], remedy


def test_a_healthy_machine(domain_id):
    code, lines = examine()
    assert code == 0
    assert line_of(lines, f'ROS, domain {domain_id}')[0] == 'ok'
    assert 'numpy' in line_of(lines, 'packages')[1]
    assert lines[0].startswith('ok     system: Python 3.')
    assert not [line for line in lines if line.startswith('FAULT')]


@pytest.mark.parametrize(('name', 'value', 'level', 'code'), [
    ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF', 'FAULT', 1),
    ('FASTRTPS_DEFAULT_PROFILES_FILE', '/no/profile.xml', 'FAULT', 1),
    ('RMW_IMPLEMENTATION', 'rmw_cyclonedds_cpp', 'note', 0)])
def test_variables_of_another_shell(domain_id, monkeypatch, name, value, level, code):
    if level == 'note':
        for variable in ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE'):  # as in a shell
            monkeypatch.delenv(variable)
    ended, lines = examine(replace(HEALTHY, variables={name: value}))
    found, _, remedy = line_of(lines, f'{name}: ')
    assert (ended, found) == (code, level)
    assert f'unset {name}' in remedy


def test_a_domain_that_is_none_is_one_fault(domain_id):
    code, lines = examine(replace(HEALTHY, variables={'ROS_DOMAIN_ID': 'mine'}))
    [fault] = [line for line in lines if line.startswith('FAULT')]
    assert code == 1 and "ROS_DOMAIN_ID is 'mine': it must be a number from 0 to 232" in fault


def test_variables_of_the_page(domain_id, monkeypatch):
    for variable in ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE'):
        monkeypatch.delenv(variable)
    code, lines = examine(VARIABLES)
    assert code == 1 and is_shown(VARIABLES, lines)


def test_what_is_pasted_into_a_report_of_a_fault_names_no_home(domain_id):
    home = os.path.expanduser('~')
    _, lines = examine(replace(HEALTHY, variables={
        'FASTRTPS_DEFAULT_PROFILES_FILE': f'{home}/profile.xml', 'ROS_SECURITY_KEYSTORE': home,
        'ROS_STATIC_PEERS': f'/mnt{home}/a'}))
    text = '\n'.join(lines)
    assert '~/profile.xml' in text and 'ROS_SECURITY_KEYSTORE=~' in text
    assert f'/mnt{home}/a' in text and home not in text.replace(f'/mnt{home}', '')


def test_a_domain_that_a_simulator_has(start_node, domain_id):
    start_node('panda_sim_node').wait_for_log('ready')
    code, lines = examine(DOMAIN)
    level, text, _ = line_of(lines, f'ROS, domain {domain_id}')
    assert (code, level) == (1, 'FAULT')
    assert '/panda_sim_node' in text and 'set ROS_DOMAIN_ID to another number' in text
    assert is_shown(DOMAIN, lines)


def test_full_shared_memory(domain_id):
    if subprocess.run(['unshare', '--mount', 'true'], capture_output=True, check=False).returncode:
        pytest.skip('this user may not mount')
    code, lines = examine(SHARED_MEMORY)
    level, text, remedy = line_of(lines, '/dev/shm')
    assert (code, level) == (1, 'FAULT')
    assert '0 of 67 MB free' in text and 'remount,size=' in remedy
    assert 'SIGBUS, as when /dev/shm is full' in line_of(lines, 'ROS, domain')[1]
    assert is_shown(SHARED_MEMORY, lines)


def test_little_shared_memory(domain_id):
    if subprocess.run(['unshare', '--mount', 'true'], capture_output=True, check=False).returncode:
        pytest.skip('this user may not mount')
    mount = 'mount -t tmpfs -o size=1m tmpfs /dev/shm && exec "$@"'
    code, lines = examine(replace(HEALTHY, under=('unshare', '--mount', 'sh', '-c', mount, '-')))
    level, text, _ = line_of(lines, '/dev/shm')
    assert (code, level) == (0, 'note')  # and nodes find each other all the same
    assert 'of 1 MB free' in text


def test_no_real_time_limit(domain_id):
    code, lines = examine(NO_REAL_TIME)
    level, text, remedy = line_of(lines, 'real-time priority')
    assert (code, level) == (0, 'note')
    assert 'ulimit -r is 0' in text and 'limits.d' in remedy
    assert is_shown(NO_REAL_TIME, lines)


def test_no_browser(domain_id):
    code, lines = examine(NO_BROWSER)
    level, _, remedy = line_of(lines, 'Chromium')
    assert (code, level) == (0, 'note')
    assert remedy.endswith('tools/install_browser.sh')
    assert is_shown(NO_BROWSER, lines)


def test_it_imports_nothing_heavy():
    script = ('import sys; from shared_control_bringup.doctor.command import findings; '
              'print(*(name.partition(".")[0] for name in sys.modules))')
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True, check=True)
    heavy = {'rclpy', 'torch', 'pybullet', 'pandas', 'matplotlib', 'gymnasium', 'pinocchio', 'numpy'}
    assert not set(done.stdout.split()) & heavy


def test_the_browser_is_the_one_on_the_path(domain_id):
    if not shutil.which('chromedriver'):
        pytest.skip('no Chromium here')
    _, lines = examine()
    assert line_of(lines, 'Chromium')[0] == 'ok'
