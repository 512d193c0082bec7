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

"""A loop as Fast DDS froze one: a thread that spins on a lock, on the loop's own core, while that holds it."""

import subprocess
import sys

from shared_control.processes import leave_with_the_parent

AS_IT_WAS = 'all at one priority'
AS_NODES_HAVE_IT = 'the loop above the other threads'
PRIORITIES = (AS_IT_WAS, AS_NODES_HAVE_IT)
"""Who has which real-time priority: ``put_loop_above_other_threads`` makes the second of the first."""

_LOOP = """
import ctypes, os, sys, threading, time
from shared_control_ros.real_time import put_loop_above_other_threads
from shared_control_ros.watchdog import Watchdog
is_as_it_was, seconds = sys.argv[1] == 'True', float(sys.argv[2])
libc = ctypes.CDLL(None)
lock = ctypes.byref(ctypes.c_int())
libc.pthread_spin_init(lock, 0)

def as_the_middleware_does():
    while True:
        libc.pthread_spin_lock(lock)
        libc.pthread_spin_unlock(lock)
        time.sleep(0.0005)

os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
os.sched_setscheduler(0, os.SCHED_FIFO if is_as_it_was else os.SCHED_RR, os.sched_param(40))
threading.Thread(target=as_the_middleware_does, daemon=True).start()
if not is_as_it_was:
    put_loop_above_other_threads()
watchdog = Watchdog(standstill=2.0)
end, rounds = time.monotonic() + seconds, 0
while time.monotonic() < end:
    watchdog.feed()
    libc.pthread_spin_lock(lock)
    time.sleep(0.001)  # the holder waits for something, and the other thread comes to run
    libc.pthread_spin_unlock(lock)
    rounds += 1
print(rounds, flush=True)
os._exit(0)
"""


def run_loop(priorities: str, seconds: float) -> tuple[int, int]:
    """Run it for so long: exit code (-SIGALRM: the watchdog ended it), and how often it came round (0: nobody knows).

    It needs real-time priority (root, or ``ulimit -r``).
    """
    command = [sys.executable, '-c', _LOOP, str(priorities == AS_IT_WAS), str(seconds)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=seconds + 60.0,
                           preexec_fn=leave_with_the_parent)
    return ended.returncode, int(ended.stdout or 0)
