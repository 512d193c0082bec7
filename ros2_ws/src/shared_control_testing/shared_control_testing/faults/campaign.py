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

"""Runs the faults of a plan against sessions on the live graph, and looks at what has become of each."""

import multiprocessing
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
from multiprocessing.context import ForkProcess
from pathlib import Path

from shared_control.contract import CONTROLLER_ENABLE, CONTROLLER_RESET
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.processes import leave_with_the_parent
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

from ..live_session import Session
from ..nodes import Observer
from .checks import violations
from .machine import Machine
from .messages import disturb
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
STOPPED_S = 1.0
"""Time for an emergency stop to bring the arm to rest."""
SILENT_S = 400.0
"""Longer than a session goes on without a fault, or takes to end."""
LEAVE_S = 15.0
"""Time for the campaign's own node to leave the graph."""
_PROCESSES = multiprocessing.get_context('fork')


@dataclass
class Outcome:
    """What became of a fault."""

    fault: Fault
    session: str
    what: str = ''
    """What was done, and when."""
    violations: list[str] = field(default_factory=list)
    judged: bool = True
    """False when nothing can be said, since the campaign's own process stood still or failed."""


@dataclass
class _Seen:
    """What the process of a session has seen so far."""

    outcomes: list[Outcome] = field(default_factory=list)
    killed_ns: list[int] = field(default_factory=list)
    """When the recorder was killed."""
    ended: bool = False


class Campaign:
    """A row of sessions and the faults that befall them.

    Args:
        faults: in their order.
        folder: for the sessions' folders; made.
        domain: the ROS domain of the sessions.
        say: called with a line for every fault.
    """

    def __init__(self, faults: list[Fault], folder: Path, domain: int, say: Callable[[str], None] = print):
        folder.mkdir(parents=True, exist_ok=True)
        self._machine = Machine(folder)
        self._waiting = list(faults)
        self._folder, self._domain, self._say = folder, domain, say
        self.outcomes: list[Outcome] = []
        self._parameters = folder / 'unpaced.yaml'
        self._parameters.write_text(PARAMETERS)

    def run(self, deadline: float = float('inf')) -> list[Outcome]:
        """All faults, or those that begin before ``deadline`` (``time.monotonic()``).

        An interrupt ends the session that runs; :attr:`outcomes` has those of the sessions before it.
        """
        number = 0
        while self._waiting and time.monotonic() < deadline:
            number += 1
            self._see_session(self._folder / f'session_{number:03d}', deadline)
        return self.outcomes

    def _see_session(self, folder: Path, deadline: float) -> None:
        """Run a session from a process of its own, and look at what has become of it.

        A garbled packet can hold up the middleware of whoever receives it for ever (seen: Fast DDS 2.14, in a gap of
        messages without end). A node of the session that stands still so is ended by its supervisor, the campaign's
        own node here.
        """
        results, sender = _PROCESSES.Pipe(duplex=False)
        process = _PROCESSES.Process(target=self._run_session, args=(folder, deadline, sender))
        process.start()
        sender.close()
        seen = _Seen()
        try:
            with suppress(EOFError):
                while not seen.ended and results.poll(SILENT_S):
                    seen = results.recv()
        finally:
            process.join(LEAVE_S)
            process.kill()
            process.join()
        if seen.ended:
            clock_was_set = any(outcome.fault.kind == 'clock' for outcome in seen.outcomes)
            self._check(folder, seen.outcomes, [] if clock_was_set else seen.killed_ns)
        else:  # the faults before the last one are done again
            seen.outcomes = seen.outcomes[-1:]
            for outcome in seen.outcomes:
                outcome.judged = False
                self._say(f'{outcome.fault} ({folder.name}): not judged, since the process that saw it '
                          f'{_ended(process)}')
        done = [outcome.fault for outcome in seen.outcomes]
        self._waiting = [fault for fault in self._waiting if fault not in done]
        self.outcomes += seen.outcomes

    def _run_session(self, folder: Path, deadline: float, results: Connection) -> None:
        leave_with_the_parent()
        self._machine.set_clock(-self._machine.clock_s)
        graph = _Graph(self._domain)
        session = self._start(folder)
        seen = _Seen()
        try:
            for fault in self._waiting:
                if time.monotonic() >= deadline or not graph.wait_for_phase(fault.phase, session):
                    break
                time.sleep(fault.wait)
                if session.process.poll() is not None:
                    break
                outcome = Outcome(fault, folder.name)
                seen.outcomes.append(outcome)
                results.send(seen)
                try:
                    if fault.kind == 'interrupt':
                        session = self._interrupt(session, folder, outcome)
                    else:
                        self._inject(outcome, session, graph, seen.killed_ns)
                except (AssertionError, subprocess.TimeoutExpired) as error:  # what was waited for did not come
                    outcome.violations.append(f'{fault.kind}: {error}')
                    break
                self._say(f'{fault}: {outcome.what}')
                moved = graph.wait_for_change(session, MUST_MOVE_S)
                if not moved:
                    outcome.violations.append(f'standstill: no phase began within {MUST_MOVE_S:.0f} s')
                    break
            self._end(session, seen.outcomes)
            seen.ended = True
        finally:
            session.close()
            results.send(seen)
            graph.close()

    def _start(self, folder: Path, *options: str) -> Session:
        log = (self._folder / f'{folder.name}.log').open('a')
        arguments = options or (
            '--tutor', 'sim', '--episodes', str(EPISODES), '--test-episodes', '1', '--seed', '0',
            '--params-file', str(self._parameters), '--output', str(folder))
        with log:
            return Session(list(arguments), stdout=log, stderr=log, env={**os.environ, **self._machine.environment})

    def _interrupt(self, session: Session, folder: Path, outcome: Outcome) -> Session:
        """Ctrl-C, and on with what is there."""
        session.process.send_signal(signal.SIGINT)
        outcome.what = 'Ctrl-C, then --resume'
        code = session.process.wait(120)
        if code not in (0, 130):
            outcome.violations.append(f'end: exit code {code} after Ctrl-C')
        return self._start(folder, '--resume', str(folder))

    def _inject(self, outcome: Outcome, session: Session, graph: '_Graph', killed_ns: list[int]) -> None:
        fault = outcome.fault
        topics = {topic.name: topic for topic in TOPICS}
        if fault.target in topics:
            sent = graph.disturb(contract.ros_topic(topics[fault.target]), fault)
            outcome.what = f'{sent} messages'
            return
        if fault.kind == 'network':
            share = random.Random(fault.seed).uniform(0.02, 0.3)
            self._machine.fail(fault.target, share)
            graph.serve_for(fault.seconds)
            self._machine.fail(fault.target, 0.0)
            outcome.what = f'{share:.0%} of all packets'
            return
        if fault.kind == 'clock':
            self._set_clock(outcome, session)
            return
        process = session.node(fault.target)
        if not process:
            outcome.what = 'the node was not there'
            return
        outcome.what = DONE.get(fault.kind, '')
        with suppress(ProcessLookupError):  # it may die of it
            match fault.kind:
                case 'kill':
                    if fault.target == 'session_recorder_node':
                        killed_ns.append(time.time_ns())
                    os.kill(process, signal.SIGKILL)
                case 'stop':
                    _paused(process, fault.seconds, graph.serve)
                case 'delay':
                    draw = random.Random(fault.seed)
                    end = time.monotonic() + fault.seconds
                    while time.monotonic() < end:
                        _paused(process, draw.uniform(0.005, 0.1), graph.serve)
                        time.sleep(draw.uniform(0.005, 0.1))
                case 'disk full':
                    before = resource.prlimit(process, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
                    graph.serve_for(fault.seconds)
                    resource.prlimit(process, resource.RLIMIT_FSIZE, before)
                case 'emergency stop':
                    outcome.violations += graph.emergency_stop(session, process)

    def _set_clock(self, outcome: Outcome, session: Session) -> None:
        """Set the clock, and, in every other case, start the simulator anew: the robot's time is set with it."""
        fault = outcome.fault
        step = 60.0 * fault.seconds if fault.target == 'forward' else -60.0 * fault.seconds
        self._machine.set_clock(step)
        outcome.what = f'by {step:.0f} s'
        if fault.seed % 2 and (simulator := session.node('panda_sim_node')):
            with suppress(ProcessLookupError):
                os.kill(simulator, signal.SIGKILL)
            outcome.what += ', and the simulator killed'

    def _end(self, session: Session, outcomes: list[Outcome]) -> None:
        """Let it come to its end, or ask it to: whichever, in order."""
        if session.process.poll() is None:
            session.process.send_signal(signal.SIGINT)
        try:
            code = session.process.wait(180)
        except Exception:
            outcomes[-1].violations.append('end: the session did not end within 180 s of Ctrl-C')
            return
        if code not in (0, 130) and outcomes:
            outcomes[-1].violations.append(f'end: exit code {code}')

    def _check(self, folder: Path, outcomes: list[Outcome], killed_ns: list[int]) -> None:
        """What does not hold in the folder counts for the session's last fault; the line says which session."""
        if not outcomes:
            return
        lost_rows = any(outcome.fault.target == 'session_recorder_node' for outcome in outcomes)
        outcomes[-1].violations += violations(folder, killed_ns, lost_rows)
        for outcome in outcomes:
            for violation in outcome.violations:
                self._say(f'VIOLATION after {outcome.fault} ({outcome.session}): {violation}')


class _Graph:
    """The campaign's own node on the sessions' graph."""

    def __init__(self, domain: int):
        self.observer = Observer(domain)
        self._phases = self.observer.listen(contract.PHASE, 100)
        self._seen = 0
        self._heard: dict[str, Polled] = {}

    def disturb(self, topic: contract.Topic, fault: Fault) -> int:
        """Mix a stranger's messages into a topic; how many."""
        if topic.name not in self._heard:
            self._heard[topic.name] = Polled(self.observer.node, topic)
            self.serve_for(0.5)  # until the publishers have found it
        return disturb(self.observer.node, topic, self._heard[topic.name], fault.kind, fault.seconds, fault.seed,
                       self.serve)

    def serve(self) -> None:
        """Take what waits."""
        self.observer.take_all()

    def serve_for(self, seconds: float) -> None:
        """Take what comes for so long."""
        self.observer.spin_for(seconds)

    def wait_for_phase(self, phase: str, session: Session, timeout: float = 120.0) -> bool:
        """Wait for the beginning of ``phase``; False when the session ends or that does not come."""
        deadline = time.monotonic() + timeout
        while session.process.poll() is None and time.monotonic() < deadline:
            self.serve_for(0.02)
            fresh, self._seen = self._phases[self._seen:], len(self._phases)
            if any(message.data == phase for message in fresh):
                return True
        return False

    def wait_for_change(self, session: Session, timeout: float) -> bool:
        """Wait for the beginning of any phase, or for the session's end; whether either came."""
        deadline = time.monotonic() + timeout
        before = self._seen = len(self._phases)
        while time.monotonic() < deadline:
            if session.process.poll() is not None or len(self._phases) > before:
                return True
            self.serve_for(0.05)
        return False

    def emergency_stop(self, session: Session, controller: int) -> list[str]:
        """Stop, kill the controller, see that it stays stopped, and reset; what was wrong."""
        observer = self.observer
        publisher = observer.publisher(contract.EMERGENCY_STOP)
        observer.spin(lambda: publisher.get_subscription_count(), what='a subscriber of /emergency_stop')
        publisher.publish(Bool(data=True))
        observer.spin_for(STOPPED_S)
        with suppress(ProcessLookupError):
            os.kill(controller, signal.SIGKILL)
        observer.spin(lambda: session.node('torque_ctrl_node') not in (0, controller), 60.0, 'a new controller')
        commands = observer.listen(contract.EFFORT_COMMANDS)
        observer.spin(lambda: observer.node.count_publishers(contract.EFFORT_COMMANDS.name) > 0, 60.0, 'its commands')
        observer.spin_for(2 * STOPPED_S)
        wrong = [f'emergency stop: {len(commands)} torques after a restart of the controller'] if commands else []
        for service, name, request in ((Trigger, CONTROLLER_RESET.name, Trigger.Request()),
                                       (SetBool, CONTROLLER_ENABLE.name, SetBool.Request(data=True))):
            try:
                observer.call(service, name, request, 10.0)
            except AssertionError:  # an answer is lost when it comes before whoever asked has been found
                observer.call(service, name, request)
        observer.node.destroy_publisher(publisher)
        return wrong

    def close(self) -> None:
        """Leave."""
        self.observer.close()


def _ended(process: ForkProcess) -> str:
    """How the process of a session ended that told nothing."""
    return 'stood still' if process.exitcode == -signal.SIGKILL else f'failed ({process.exitcode})'


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
