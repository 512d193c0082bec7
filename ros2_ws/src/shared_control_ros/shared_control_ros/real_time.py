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

"""What a node's own loop needs to be on time: priority, timers, no collection of garbage."""

import ctypes
import gc
import os
from contextlib import suppress


def put_loop_above_other_threads() -> None:
    """In a process that was started with SCHED_RR, put the calling thread one above the others, with SCHED_FIFO.

    Call it when the threads of the middleware are there. Fast DDS has a thread that spins on a lock; at the loop's own
    priority, on the loop's own core, it kept the thread that held that lock from ever running again, and the session
    stood still for good. Threads that the loop starts from now on have no real-time priority.
    """
    if os.sched_getscheduler(0) != os.SCHED_RR:
        return
    above = os.sched_param(os.sched_getparam(0).sched_priority + 1)
    with suppress(PermissionError):  # `ulimit -r` allows just what the process was given
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, above)


def keep_loop_on_time() -> None:
    """Call it in the thread of the loop, before the loop begins.

    What a tick makes is freed by reference counts: a collection in mid-tick would only make it late. And without
    real-time priority the kernel lets the timers of a thread be 50 us late, so that a sleep lasts longer than asked
    for, and a look at what has arrived took 70 us instead of 20.
    """
    gc.freeze()
    gc.disable()
    set_timer_slack, least_ns = 29, 1
    ctypes.CDLL(None).prctl(set_timer_slack, least_ns)
