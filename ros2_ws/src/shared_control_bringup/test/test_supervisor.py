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

"""The supervisor and real nodes."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from shared_control_bringup import node_process, parameters
from shared_control_bringup import supervisor as supervising
from shared_control_bringup.node_process import NodeProcess
from shared_control_bringup.supervisor import SessionError, Supervisor


@pytest.fixture
def make_node(domain_id, tmp_path):
    file = tmp_path / 'parameters.yaml'
    parameters.save(parameters.load(), file)

    def make(name, *, in_control_loop=False, in_real_time=False, **changes):
        if changes:
            content = parameters.load()
            content[name].update(changes)
            parameters.save(content, file)
        return NodeProcess(name, file, tmp_path / f'{name}.log', in_control_loop=in_control_loop,
                           in_real_time=in_real_time)

    return make


def poll_until(supervisor, condition, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        assert supervisor.poll()
        time.sleep(0.05)


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_killed_node_is_started_again_and_all_are_stopped(make_node):
    said = []
    nodes = [make_node('panda_sim_node'), make_node('torque_ctrl_node')]
    supervisor = Supervisor(nodes, 'ppo_agent_node', said.append)
    supervisor.start()
    try:
        killed = nodes[1].pid
        os.kill(killed, signal.SIGKILL)
        poll_until(supervisor, lambda: nodes[1].pid != killed)
        assert said == ['torque_ctrl_node died (signal 9); starting it again']
        assert supervisor.restarts == 1
        assert nodes[1].wait_ready(60.0)
    finally:
        supervisor.stop()
    assert not any(alive(node.pid) for node in nodes)
    assert [node.exit_code() for node in nodes] == [0, 0]


def test_a_node_is_ready_when_it_says_so_and_not_before(make_node):
    node = make_node('panda_sim_node')
    node.log.write_text('already\n')  # of an earlier run, or any line with the word in it
    node.start()
    assert not node.wait_ready(0.0)
    assert node.wait_ready(60.0)
    assert not node.wait_ready(0.0), 'once a start'
    node.interrupt()
    node.wait(60)


def test_nobody_waits_for_a_node_that_has_ended(make_node):
    node = make_node('panda_sim_node', mode='sideways')
    node.start()
    assert not node.wait_ready(600.0)


def test_a_wrong_parameter_ends_the_session_and_is_told(make_node):
    node = make_node('panda_sim_node', mode='sideways')
    supervisor = Supervisor([node], 'ppo_agent_node', print)
    with pytest.raises(SessionError, match=r"panda_sim_node: .*'mode' has no choice 'sideways'"):
        supervisor.start()


def test_a_node_that_dies_again_and_again_ends_the_session(make_node):
    node = make_node('torque_ctrl_node')
    node.log.write_text('[ERROR] [1.0] [torque_ctrl_node]: an error of an earlier run\n')
    supervisor = Supervisor([node], 'ppo_agent_node', lambda _: None)
    supervisor.start()

    def kill():
        os.kill(node.pid, signal.SIGKILL)
        return False

    with pytest.raises(SessionError, match='died 6 times in a row') as raised:
        poll_until(supervisor, kill)
    supervisor.stop()
    assert 'earlier run' not in str(raised.value) and node.newest_warning() is None


def test_a_leader_that_somebody_has_ended_has_not_done_its_work(make_node):
    said = []
    node = make_node('torque_ctrl_node')
    supervisor = Supervisor([node], 'torque_ctrl_node', said.append)
    supervisor.start()
    os.kill(node.pid, signal.SIGTERM)
    poll_until(supervisor, lambda: said)
    supervisor.stop()
    assert said == ['torque_ctrl_node died (somebody ended it); starting it again']


LATE_LEAVER = """
import os, time
from rclpy.node import Node
from shared_control_ros import runner

class Late(Node):
    def destroy_node(self):
        {leave}

class Work:
    def __init__(self):
        self.node = Late('late_leaver')
    def run(self, stop):
        {run}
    def close(self):
        pass

runner.LEAVE_SECONDS = 0.2
raise SystemExit(runner.run(Work))
"""


@pytest.mark.parametrize(('run', 'leave', 'finished'), [
    ('pass', 'time.sleep(60.0)', True), ('pass', 'os.abort()', True), ('raise KeyError', 'time.sleep(60.0)', False)])
def test_a_leader_that_has_done_all_is_not_started_again_for_how_it_leaves(domain_id, tmp_path, monkeypatch, run, leave,
                                                                           finished):
    (tmp_path / 'late_leaver.py').write_text(LATE_LEAVER.replace('{run}', run).replace('{leave}', leave))
    (tmp_path / 'p.yaml').write_text('')
    monkeypatch.setattr(node_process, 'node_module', lambda name: name)
    said = []
    node = NodeProcess('late_leaver', tmp_path / 'p.yaml', tmp_path / 'log', environment={'PYTHONPATH': str(tmp_path)})
    supervisor = Supervisor([node], 'late_leaver', said.append)
    supervisor.start()
    try:
        while supervisor.poll() and not said:
            time.sleep(0.05)
    finally:
        supervisor.stop()
    assert bool(said) is not finished


COMPUTES, SLEEPS = 'while not done.exists(): pass', 'time.sleep(60.0)'
STAYS = """
import os, signal, time
from pathlib import Path
from shared_control_ros.readiness import READY, ReadyPipe

asked, done = [], Path({done!r})
signal.signal(signal.SIGINT, lambda *_: asked.append(True))
ReadyPipe().tell(READY)
while not asked:
    time.sleep(0.01)
{then}
"""


class Stays:
    """A node that goes on when it is asked to leave, and whoever stops it."""

    def __init__(self, folder, then):
        self.done, self.said = folder / 'done', []
        self.node = NodeProcess('ppo_agent_node', folder / 'none.yaml', folder / 'log')
        self.node._command = [sys.executable, '-c', STAYS.format(done=str(self.done), then=then)]
        self.supervisor = Supervisor([self.node], 'ppo_agent_node', print)
        self.supervisor.start()

    def learns(self):
        """It comes to its end after it was seen to compute."""
        used = self.node.cpu_seconds()
        while self.node.cpu_seconds() < used + 0.05:
            time.sleep(0.01)
        self.done.touch()
        return True


@pytest.fixture
def stays(domain_id, tmp_path, monkeypatch):
    monkeypatch.setattr(supervising, 'STOP_SECONDS', 0.5)

    def start(then):
        started.append(Stays(tmp_path, then))
        return started[-1]
    started = []
    yield start
    for one in started:
        one.node.kill()
        one.node.wait(60.0)


def test_what_a_leader_still_learns_is_waited_for(stays, monkeypatch):
    monkeypatch.setattr(supervising, 'COMPUTES', 0.0)  # others may want all cores for a while
    busy = stays(COMPUTES)
    busy.supervisor.stop(say=busy.said.append, learns=busy.learns)
    said, = busy.said
    assert 'ppo_agent_node still learns from the last episode' in said and 'Ctrl-C again ends it' in said
    assert busy.node.exit_code() == 0 and busy.node.cpu_seconds() == 0.0


@pytest.mark.parametrize(('then', 'share', 'learns', 'presses'), [
    (COMPUTES, 0.0, True, [1, 1, 2]),  # somebody does not want to wait
    (COMPUTES, 0.0, False, [1]),
    (SLEEPS, 0.1, True, [1]),  # it does not come to its end
])
def test_a_node_that_is_ended_by_force_is_named(stays, monkeypatch, then, share, learns, presses):
    monkeypatch.setattr(supervising, 'COMPUTES', share)
    one = stays(then)
    one.supervisor.stop(say=one.said.append, learns=lambda: learns,
                        asked=lambda: presses.pop(0) if len(presses) > 1 else presses[0])
    assert one.node.exit_code() == -signal.SIGKILL
    *waited, ended = one.said
    assert ended == f'ppo_agent_node did not leave when it was asked to, and is ended by force; see {one.node.log_name}'
    assert ['still learns' in text for text in waited] == [True] * learns


def test_an_unpaced_loop_shares_all_cores(make_node):
    """Pinned to one core, one of two such sessions stood still until the other had ended."""
    node = make_node('torque_ctrl_node', in_control_loop=True)
    node.start()
    try:
        assert node.wait_ready(60.0)
        node.confine()
        assert os.sched_getaffinity(node.pid) == os.sched_getaffinity(0)
    finally:
        node.interrupt()
        node.wait(60)


def test_nodes_leave_when_the_session_is_killed(domain_id, tmp_path):
    script = f"""
import time
from pathlib import Path
from shared_control_bringup import parameters
from shared_control_bringup.node_process import NodeProcess
parameters.save(parameters.load(), Path({str(tmp_path / 'p.yaml')!r}))
node = NodeProcess('torque_ctrl_node', Path({str(tmp_path / 'p.yaml')!r}), Path({str(tmp_path / 'log')!r}))
node.start()
node.wait_ready(60.0)
print(node.pid, flush=True)
time.sleep(60)
"""
    session = subprocess.Popen([sys.executable, '-c', script], stdout=subprocess.PIPE, text=True)
    pid = int(session.stdout.readline())
    assert alive(pid)
    session.kill()
    session.wait()
    deadline = time.monotonic() + 60.0
    while alive(pid):
        assert time.monotonic() < deadline
        time.sleep(0.05)


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason='one core: there is no choice')
def test_paced_loops_of_two_domains_have_two_cores(make_node, monkeypatch):
    cores = []
    for domain in ('0', '1'):
        monkeypatch.setenv('ROS_DOMAIN_ID', domain)
        node = make_node('torque_ctrl_node', in_control_loop=True, in_real_time=True)
        node.start()
        cores.append(os.sched_getaffinity(node.pid))
        node.kill()
        node.wait(60.0)
    assert cores == [{core} for core in sorted(os.sched_getaffinity(0))[:-3:-1]]


def test_in_real_time_the_loop_runs_before_the_threads_of_the_middleware(make_node):
    """At one priority on one core, a thread of Fast DDS that spins on a lock can keep its holder from running."""
    try:
        os.sched_setscheduler(os.getpid(), os.SCHED_RR, os.sched_param(1))
    except PermissionError:
        pytest.skip('real-time priority needs root, or `ulimit -r`')
    os.sched_setscheduler(os.getpid(), os.SCHED_OTHER, os.sched_param(0))
    node = make_node('torque_ctrl_node', in_control_loop=True, in_real_time=True)
    node.start()
    try:
        assert node.wait_ready(60.0)
        threads = [int(path.name) for path in Path(f'/proc/{node.pid}/task').iterdir()]
        priority = {thread: os.sched_getparam(thread).sched_priority for thread in threads}
        assert os.sched_getscheduler(node.pid) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO
        assert len(threads) > 3 and max(p for thread, p in priority.items() if thread != node.pid) < priority[node.pid]
    finally:
        node.interrupt()
        node.wait(60)
