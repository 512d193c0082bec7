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

"""One session of a campaign, in a process of its own, and the faults that befall it."""

import os
import random
import resource
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

from shared_control.processes import leave_with_the_parent
from shared_control_ros import contract

from ..live_session import Session
from .graph import Graph
from .machine import Machine
from .plan import TOPICS, Fault

EPISODES = 12
"""How many a session teaches; it meets as many faults as fit into it."""
PARAMETERS = """\
panda_sim_node: {ros__parameters: {paced: false}}
ppo_agent_node: {ros__parameters: {episode_seconds: 4.0}}
"""
MUST_MOVE_S = 90.0
"""Within so long after a fault the learner begins another phase, or the session ends."""
DONE = {'kill': 'killed', 'stop': 'stopped and continued', 'delay': 'slowed down', 'disk full': 'could write no file',
        'emergency stop': 'stopped, controller killed, then reset'}


@dataclass
class Outcome:
    """What became of a fault."""

    fault: Fault
    session: str
    what: str = ''
    """What was done, and when."""
    violations: list[str] = field(default_factory=list)
    judged: bool = True
    """False when nothing can be said, since the process that saw the session stood still or failed."""


@dataclass
class Seen:
    """What the process of a session has seen so far."""

    outcomes: list[Outcome] = field(default_factory=list)
    killed_ns: list[int] = field(default_factory=list)
    """When the recorder was killed."""
    ended: bool = False


def run_session(faults: list[Fault], folder: Path, domain: int, deadline: float, results: Connection) -> None:
    """Run a session through as many faults as it meets.

    Args:
        faults: in their order.
        folder: the session's; beside it stand its output and what all sessions share.
        domain: the session's ROS domain.
        deadline: begin no fault after that (``time.monotonic()``).
        results: is sent a line for every fault, and :class:`Seen` before each of them and in the end.
    """
    leave_with_the_parent()
    run = _Run(folder, domain, results)
    try:
        run.meet(faults, deadline)
    finally:
        run.close()


class _Run:
    """The session, the machine that it lives on, and a node on its graph."""

    def __init__(self, folder: Path, domain: int, results: Connection):
        self._folder, self._results = folder, results
        self._seen = Seen()
        self._machine = Machine(folder.parent)
        parameters = folder.with_name('unpaced.yaml')
        parameters.write_text(PARAMETERS)
        self._graph = Graph(domain)
        self._session = self._start(
            '--tutor', 'sim', '--episodes', str(EPISODES), '--test-episodes', '1', '--seed', '0',
            '--params-file', str(parameters), '--output', str(folder))

    def meet(self, faults: list[Fault], deadline: float) -> None:
        """Let the faults befall the session, one after the other, until it ends."""
        for fault in faults:
            if time.monotonic() >= deadline or not self._graph.wait_for_phase(fault.phase, self._session):
                break
            time.sleep(fault.wait)
            if self._session.process.poll() is not None:
                break
            outcome = Outcome(fault, self._folder.name)
            self._seen.outcomes.append(outcome)
            self._results.send(self._seen)
            try:
                self._inject(outcome)
            except (AssertionError, subprocess.TimeoutExpired) as error:  # what was waited for did not come
                outcome.violations.append(f'{fault.kind}: {error}')
                break
            self._results.send(f'{fault}: {outcome.what}')
            if not self._graph.wait_for_change(self._session, MUST_MOVE_S):
                outcome.violations.append(f'standstill: no phase began within {MUST_MOVE_S:.0f} s')
                break
        self._end()
        self._seen.ended = True

    def close(self) -> None:
        """End the session, tell what was seen, and leave."""
        self._session.close()
        self._results.send(self._seen)
        self._graph.close()
        self._machine.close()

    def _start(self, *options: str) -> Session:
        with self._folder.with_name(f'{self._folder.name}.log').open('a') as log:
            return Session(list(options), stdout=log, stderr=log, env={**os.environ, **self._machine.environment})

    def _interrupt(self, outcome: Outcome) -> None:
        """Ctrl-C, and on with what is there."""
        self._session.process.send_signal(signal.SIGINT)
        outcome.what = 'Ctrl-C, then --resume'
        code = self._session.process.wait(120)
        if code not in (0, 130):
            outcome.violations.append(f'end: exit code {code} after Ctrl-C')
        self._session = self._start('--resume', str(self._folder))

    def _inject(self, outcome: Outcome) -> None:
        fault = outcome.fault
        if fault.kind == 'interrupt':
            self._interrupt(outcome)
            return
        topics = {topic.name: topic for topic in TOPICS}
        if fault.target in topics:
            sent = self._graph.disturb(contract.ros_topic(topics[fault.target]), fault)
            outcome.what = f'{sent} messages'
            return
        if fault.kind == 'network':
            share = random.Random(fault.seed).uniform(0.02, 0.3)
            self._machine.fail(fault.target, share)
            self._graph.serve_for(fault.seconds)
            self._machine.fail(fault.target, 0.0)
            outcome.what = f'{share:.0%} of all packets'
            return
        if fault.kind == 'clock':
            self._set_clock(outcome)
            return
        process = self._session.node(fault.target)
        if not process:
            outcome.what = 'the node was not there'
            return
        outcome.what = DONE.get(fault.kind, '')
        with suppress(ProcessLookupError):  # it may die of it
            match fault.kind:
                case 'kill':
                    if fault.target == 'session_recorder_node':
                        self._seen.killed_ns.append(time.time_ns())
                    os.kill(process, signal.SIGKILL)
                case 'stop':
                    _paused(process, fault.seconds, self._graph.serve)
                case 'delay':
                    draw = random.Random(fault.seed)
                    end = time.monotonic() + fault.seconds
                    while time.monotonic() < end:
                        _paused(process, draw.uniform(0.005, 0.1), self._graph.serve)
                        time.sleep(draw.uniform(0.005, 0.1))
                case 'disk full':
                    before = resource.prlimit(process, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
                    self._graph.serve_for(fault.seconds)
                    resource.prlimit(process, resource.RLIMIT_FSIZE, before)
                case 'emergency stop':
                    outcome.violations += self._graph.emergency_stop(self._session, process)

    def _set_clock(self, outcome: Outcome) -> None:
        """Set the clock, and, in every other case, start the simulator anew: the robot's time is set with it."""
        fault = outcome.fault
        step = 60.0 * fault.seconds if fault.target == 'forward' else -60.0 * fault.seconds
        self._machine.set_clock(step)
        outcome.what = f'by {step:.0f} s'
        if fault.seed % 2 and (simulator := self._session.node('panda_sim_node')):
            with suppress(ProcessLookupError):
                os.kill(simulator, signal.SIGKILL)
            outcome.what += ', and the simulator killed'

    def _end(self) -> None:
        """Let it come to its end, or ask it to: whichever, in order."""
        outcomes = self._seen.outcomes
        if self._session.process.poll() is None:
            self._session.process.send_signal(signal.SIGINT)
        try:
            code = self._session.process.wait(180)
        except subprocess.TimeoutExpired:
            if outcomes:
                outcomes[-1].violations.append('end: the session did not end within 180 s of Ctrl-C')
            return
        if code not in (0, 130) and outcomes:
            outcomes[-1].violations.append(f'end: exit code {code}')


def _paused(process: int, seconds: float, serve: Callable[[], None]) -> None:
    """Stop a process for a while."""
    os.kill(process, signal.SIGSTOP)
    try:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            serve()
            time.sleep(min(0.02, seconds))
    finally:
        os.kill(process, signal.SIGCONT)
