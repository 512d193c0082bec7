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

"""A thread that spins on a lock, on the one core and at the priority of the loop that holds it; and who ends that."""

import os
import signal
import subprocess
import sys

import pytest
from shared_control_testing.standstill import AS_IT_WAS, AS_NODES_HAVE_IT, run_loop

pytestmark = pytest.mark.alone


@pytest.fixture(autouse=True)
def real_time():
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except PermissionError:
        pytest.skip('real-time priority needs root, or `ulimit -r`')
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def test_at_one_priority_it_stands_still_and_the_watchdog_ends_it():
    assert run_loop(AS_IT_WAS, 10.0) == (-signal.SIGALRM, 0)


def test_above_the_other_threads_it_goes_on():
    code, rounds = run_loop(AS_NODES_HAVE_IT, 3.0)
    assert code == 0 and rounds > 0


def test_a_loop_that_waits_for_ever_is_ended_too():
    ended = subprocess.run(
        [sys.executable, '-c', 'import time\nfrom shared_control_ros.watchdog import Watchdog\n'
         'Watchdog(standstill=0.5).feed()\ntime.sleep(60)'], timeout=50)
    assert ended.returncode == -signal.SIGALRM
