"""Two machines (docs/how_to/two_machines.md): network namespaces with a cable between, and no shared memory."""

import shutil
import subprocess
import sys
import time

import pytest
from shared_control.processes import leave_with_the_parent
from shared_control_learning.episode_table import TABLE_NAME, read_rows

NAMESPACES = ('unshare', '--user', '--map-root-user', '--net', '--mount')
TWO = r"""
set -e
mount -t tmpfs none /dev/shm
ip link set lo up
exec 3<&0
coproc OTHER { exec unshare --net --mount bash -c '
    mount -t tmpfs none /dev/shm; ip link set lo up; echo up; exec cat <&3 >&2'; }
read -r <&"${OTHER[0]}"
ip link add cable type veth peer name cable netns "$OTHER_PID"
ip address add 10.77.0.1/24 dev cable
ip link set cable up
nsenter --target "$OTHER_PID" --net sh -c 'ip address add 10.77.0.2/24 dev cable; ip link set cable up'
until ip link show cable | grep -q 'state UP'; do sleep 0.05; done
until nsenter --target "$OTHER_PID" --net ip link show cable | grep -q 'state UP'; do sleep 0.05; done
echo "$OTHER_PID"
exec cat
"""
"""Both last until their standard input ends: with the test, whatever becomes of it.

Linux may take a second to call a cable up, and a node knows only the networks that were up when it started."""


@pytest.fixture
def machines(tmp_path):
    """The Pythons of the two machines: the robot's and the other one."""
    tools = [tool for tool in ('unshare', 'nsenter', 'ip') if not shutil.which(tool)]
    if tools or subprocess.run([*NAMESPACES, 'mount', '-t', 'tmpfs', 'none', '/dev/shm'], check=False,
                               capture_output=True).returncode:
        pytest.skip(f'network namespaces need {", ".join(tools) or "a kernel that gives them to this user"}')
    with subprocess.Popen([*NAMESPACES, 'bash', '-c', TWO], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                          preexec_fn=leave_with_the_parent) as both:
        other = both.stdout.readline().strip()
        assert other
        pythons = []
        for process in (both.pid, other):
            python = tmp_path / f'python_{process}'
            python.write_text('#!/bin/sh\n'
                              f'exec nsenter --target {process} --user --net --mount --preserve-credentials '
                              f'{sys.executable} "$@"\n')
            python.chmod(0o755)
            pythons.append(str(python))
        yield pythons
        both.stdin.close()


def cable(python, state):
    """Pull or plug the cable of a machine."""
    subprocess.run([python, '-c', f'import os; os.execlp("ip", "ip", "link", "set", "cable", "{state}")'], check=True)


def until(condition, timeout=300.0):
    """Wait for it."""
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.1)


def test_a_policy_is_taught_from_another_machine(machines, start_node, monkeypatch, tmp_path):
    monkeypatch.delenv('FASTRTPS_DEFAULT_PROFILES_FILE')
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    robots, persons = machines
    output = tmp_path / 'learner'
    start_node('panda_sim_node', python=robots)
    start_node('torque_ctrl_node', python=robots, enabled=True)
    start_node('teleop_key_node', python=persons, use_sim_time=True, screen='off')
    start_node('sim_tutor_node', python=persons, use_sim_time=True)
    agent = start_node('ppo_agent_node', python=persons, use_sim_time=True, episode_seconds=4.0, output=str(output))

    def felt() -> int:
        """Episodes that were learned in which the person's moment got to the controller, and back."""
        assert agent.process.poll() is None, agent.log()
        return sum(float(row['intervention_rate']) > 0
                   for row in read_rows(output / TABLE_NAME) if row['phase'] == 'teach')

    until(lambda: felt() > 0)
    cable(robots, 'down')
    time.sleep(3.0)
    before = felt()
    cable(robots, 'up')
    until(lambda: felt() > before)
    assert agent.stop() == 0, agent.log()
