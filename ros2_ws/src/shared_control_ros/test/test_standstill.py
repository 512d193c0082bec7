"""A thread that spins on a lock, on the one core and at the priority of the loop that holds it; and who ends that."""

import os
import signal
import subprocess
import sys

import pytest

pytestmark = pytest.mark.alone

LOOP = """
import ctypes, os, sys, threading, time
from shared_control_ros.real_time import put_loop_above_other_threads
from shared_control_ros.watchdog import Watchdog, let_go
libc = ctypes.CDLL(None)
lock = ctypes.byref(ctypes.c_int())
libc.pthread_spin_init(lock, 0)

def as_the_middleware_does():
    while True:
        libc.pthread_spin_lock(lock)
        libc.pthread_spin_unlock(lock)
        time.sleep(0.0005)

os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
os.sched_setscheduler(0, os.SCHED_FIFO if sys.argv[1] == 'as it was' else os.SCHED_RR, os.sched_param(40))
threading.Thread(target=as_the_middleware_does, daemon=True).start()
if sys.argv[1] != 'as it was':
    put_loop_above_other_threads()
watchdog = Watchdog(standstill=2.0)
for _ in range(500):
    watchdog.feed()
    libc.pthread_spin_lock(lock)
    time.sleep(0.001)  # the holder waits for something, and the other thread comes to run
    libc.pthread_spin_unlock(lock)
let_go()
print('came round 500 times', flush=True)
os._exit(0)
"""


@pytest.fixture(autouse=True)
def real_time():
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except PermissionError:
        pytest.skip('real-time priority needs root, or `ulimit -r`')
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def run(priorities):
    return subprocess.run([sys.executable, '-c', LOOP, priorities], capture_output=True, text=True, timeout=60)


def test_at_one_priority_it_stands_still_and_the_watchdog_ends_it():
    ended = run('as it was')
    assert ended.returncode == -signal.SIGALRM and not ended.stdout


def test_above_the_other_threads_it_goes_on():
    ended = run('as nodes have it')
    assert (ended.returncode, ended.stdout) == (0, 'came round 500 times\n')


def test_a_loop_that_waits_for_ever_is_ended_too():
    ended = subprocess.run(
        [sys.executable, '-c', 'import time\nfrom shared_control_ros.watchdog import Watchdog\n'
         'Watchdog(standstill=0.5).feed()\ntime.sleep(60)'], timeout=50)
    assert ended.returncode == -signal.SIGALRM
