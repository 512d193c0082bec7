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

"""One node of the graph as a process."""

import math
import os
import re
import select
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from shared_control.processes import leave_with_the_parent
from shared_control_ros.processes import node_environment, node_module
from shared_control_ros.readiness import DONE, READY, READY_FD

from .neighbours import ros_domain

REAL_TIME_PRIORITY = 49
"""Priority of the threads of a node in the control loop (SCHED_RR), where `ulimit -r` allows it. The loop's own thread
goes one above them (:mod:`shared_control_ros.real_time`): to 50, the priority of ros2_control."""
NICENESS = 10
"""Niceness of the nodes outside the control loop, on a machine with one core."""
UNUSABLE = 2
"""Exit code of a node that cannot run with its parameters or files: starting it again would not help."""
LOG_END = 16_384
"""Bytes of a log in which a warning is new enough to be of interest."""
HELD = {'D': 'it waits for a disk', 'T': 'somebody has stopped it: SIGSTOP, Ctrl-Z', 't': 'a debugger holds it'}
"""States of a process (proc(5)) in which it cannot help standing still."""
_WARNING = re.compile(r'^\[(?:WARN|ERROR|FATAL)\] \[([\d.]+)\] \[[^\]]*\]: (.+)$', re.MULTILINE)


class NodeProcess:
    """A node, its parameter file and its log.

    Args:
        name: of the node and its executable.
        parameters: ROS parameter file.
        log: where stdout and stderr go, appended.
        in_foreground: stay in this process' group, so that the node can use the terminal.
        in_control_loop: it is a part of the control loop.
        in_real_time: give the control loop a core of its own, and real-time priority; an unpaced one would take them
            from all others.
        environment: variables that this node alone is given.
        after: name of the node that must be ready before this one starts.
    """

    def __init__(self, name: str, parameters: Path, log: Path, *, in_foreground: bool = False,
                 in_control_loop: bool = False, in_real_time: bool = False,
                 environment: Mapping[str, str] | None = None, after: str = ''):
        self.name = name
        self.after = after
        self._in_control_loop = in_control_loop
        self._in_real_time = in_real_time
        self._environment = dict(environment or {})
        self.log = log
        self.starts = 0
        self.started = 0.0
        """When it was started last, s of the monotonic clock."""
        self.ready_since = math.inf
        """When it was seen to be ready, s of the monotonic clock; infinite until then."""
        self._command = [sys.executable, '-m', node_module(name), '--ros-args', '--params-file', str(parameters),
                         '--disable-external-lib-logs']
        self.in_foreground = in_foreground
        """Whether it has the terminal, with Ctrl-C and Ctrl-Z, together with this process."""
        self._process: subprocess.Popen | None = None
        self._pipe: int | None = None
        self._is_starting = False
        self._has_done = False
        self._log_begins = 0

    def start(self, confined: bool = True) -> None:
        """Start it, or start it again.

        Args:
            confined: keep it off the core of the control loop, where nothing runs yet when a session begins: two cores
                import what a node needs sooner than one. Otherwise :meth:`confine` comes later.
        """
        self.starts += 1
        self.started = time.monotonic()
        self._starts_confined = confined
        if self._pipe is not None:
            os.close(self._pipe)
        self._pipe, theirs = os.pipe()
        self._is_starting, self._has_done, self.ready_since = True, False, math.inf
        environment = {**node_environment(), **self._environment, READY_FD: str(theirs)}
        try:
            with self.log.open('ab') as log:
                self._log_begins = log.tell()
                self._process = subprocess.Popen(
                    self._command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment,
                    pass_fds=(theirs,), process_group=None if self.in_foreground else 0, preexec_fn=self._prepare)
        finally:
            os.close(theirs)  # the node's end alone is left: its death ends the waiting

    @property
    def pid(self) -> int:
        """Process id."""
        assert self._process is not None, f'{self.name} was never started'
        return self._process.pid

    @property
    def log_name(self) -> str:
        """Where its log is in the session's folder, whose own path is nobody's business: this is recorded, or shown."""
        return f'{self.log.parent.name}/{self.log.name}'

    def _prepare(self) -> None:
        """In the new process: a core for the control loop, the others for everybody else.

        Simulator and controller take turns, so one core serves both, and waking the other needs no second one: on two
        cores a tick then takes 0.65 instead of 0.77 ms, and its 99th percentile 1.2 instead of 3.3 ms. An unpaced loop
        never sleeps: two of them on one core, Linux let one session stand still until the other had ended (its share
        for a group of processes, autogroup, goes wrong where they cannot change cores).
        """
        leave_with_the_parent()
        loop, others = _cores()
        if not others:
            if not self._in_control_loop:
                os.nice(NICENESS)
        elif not self._in_real_time:
            return
        elif self._in_control_loop:
            os.sched_setaffinity(0, {loop})
            with suppress(PermissionError):
                os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(REAL_TIME_PRIORITY))
        elif self._starts_confined:
            os.sched_setaffinity(0, others)

    def confine(self) -> None:
        """Leave the core of the control loop to it from now on."""
        _, others = _cores()
        if not self._in_real_time or self._in_control_loop or not others or self.exit_code() is not None:
            return
        confined: set[str] = set()
        # Threads that begin meanwhile have what their makers had: look until there is none that was not seen.
        while new := {path.name for path in Path(f'/proc/{self.pid}/task').glob('*')} - confined:
            for thread in new:
                with suppress(ProcessLookupError):
                    os.sched_setaffinity(int(thread), others)
            confined |= new

    @property
    def is_starting(self) -> bool:
        """Whether it has neither said that it is ready nor ended."""
        return self._is_starting

    def wait_ready(self, seconds: float) -> bool:
        """Wait until it says that it is ready, has ended, or the time is over; whether it is ready."""
        if not self._is_starting or self._pipe is None or not select.select([self._pipe], [], [], seconds)[0]:
            return False
        self._is_starting = False
        is_ready = os.read(self._pipe, len(READY)) == READY
        if is_ready:
            self.ready_since = time.monotonic()
        return is_ready

    def exit_code(self) -> int | None:
        """None while it runs."""
        return None if self._process is None else self._process.poll()

    @property
    def has_done(self) -> bool:
        """Whether it has said that all was done: how it takes leave of the middleware after that tells nothing."""
        self.wait_ready(0.0)
        if self._pipe is not None and not self._is_starting and select.select([self._pipe], [], [], 0.0)[0]:
            self._has_done |= os.read(self._pipe, len(DONE)) == DONE
        return self._has_done

    def interrupt(self) -> None:
        """Ask it to leave cleanly."""
        self._send(signal.SIGINT)

    def kill(self) -> None:
        """End it by force."""
        self._send(signal.SIGKILL)

    def write_traceback(self) -> None:
        """Have it write into its log what each of its threads is at (:func:`shared_control_ros.runner.run`)."""
        self._send(signal.SIGUSR1)

    def _send(self, number: int) -> None:
        if self._process is not None:
            self._process.send_signal(number)  # to nobody when it has ended

    def held_by(self) -> str:
        """What keeps it from running, in words; empty: nothing does."""
        try:
            content = Path(f'/proc/{self.pid}/stat').read_text(encoding='utf-8')
            return HELD.get(content.rpartition(')')[2].split()[0], '')
        except (OSError, IndexError):
            return ''

    def cpu_seconds(self) -> float:
        """How much it has computed, s; 0 when it has ended."""
        try:
            content = Path(f'/proc/{self.pid}/stat').read_text(encoding='utf-8')
            return sum(map(int, content.rpartition(')')[2].split()[11:13])) / os.sysconf('SC_CLK_TCK')
        except (OSError, ValueError):
            return 0.0

    def has_left(self, seconds: float | None) -> bool:
        """Wait for it to leave, so long at the most; whether it has."""
        if self._process is None:
            return True
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(seconds)
            self._is_starting = False
        return self.exit_code() is not None

    def wait(self, seconds: float) -> None:
        """Wait for it to leave; end it by force when it does not."""
        if not self.has_left(seconds):
            self.kill()
            self.has_left(None)

    def newest_warning(self) -> tuple[float, str] | None:
        """The newest warning or error since its start, if not long ago: when, s of the time of the day, and text."""
        try:
            with self.log.open('rb') as log:
                log.seek(max(self.log.stat().st_size - LOG_END, self._log_begins))
                found = _WARNING.findall(log.read().decode(errors='replace'))
        except OSError:
            return None
        return (float(found[-1][0]), found[-1][1]) if found else None

    def last_error(self) -> str:
        """The last line that it has written since it was started, one with an error if there is any."""
        text = self.log.read_bytes()[self._log_begins:].decode(errors='replace')
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        errors = [line for line in lines if 'error' in line.lower()]
        return (errors or lines or ['no output'])[-1]


def _cores() -> tuple[int, list[int]]:
    """The core of the control loop, and the others: the last, and for each further ROS domain the one before it.

    Sessions run side by side in domains of their own, and one core has no room for two loops at 1 kHz.
    """
    cores = sorted(os.sched_getaffinity(0))
    loop = cores.pop(-1 - ros_domain() % len(cores))
    return loop, cores
