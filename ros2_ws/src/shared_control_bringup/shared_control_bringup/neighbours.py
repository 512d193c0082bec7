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

"""Whether ROS works on this machine, and who is in the domain already: looked at before the nodes of a session start.

``python -m shared_control_bringup.neighbours`` prints a line of JSON, what is in the way; empty: nothing. It is a
process of its own, since the variables of a shell can keep ROS from being imported, and the session needs none of it.
"""

import json
import os
import signal
import subprocess
import sys
import time

LOOKS_FOR = 1.0
"""Nodes that run announce themselves twice a second, and answer who asks within some ms, s."""
MEETS_WITHIN = 8.0
"""Two nodes of one process that have not met after this never will, s."""
UNKNOWN = '_NODE_NAME_UNKNOWN_'
"""What rmw calls a node of which it knows topics and not yet the name."""
GIVEN_UP_AFTER = 30.0
"""s"""
DOMAINS = range(233)
"""Numbers for which the middleware has ports."""
SUSPECTS = ('ROS_', 'RMW_', 'FASTRTPS_', 'FASTDDS_', 'CYCLONEDDS_', 'PYTHONPATH', 'LD_LIBRARY_PATH')
"""Beginnings of the names of variables that ROS goes by."""


def ros_domain() -> int:
    """The ROS domain of this process and of those that it starts.

    Raises:
        ValueError: ``ROS_DOMAIN_ID`` is none.
    """
    domain = os.environ.get('ROS_DOMAIN_ID', '').strip() or '0'
    if not domain.isdecimal() or int(domain) not in DOMAINS:
        raise ValueError(f'ROS_DOMAIN_ID is {domain!r}: it must be a number from 0 to {DOMAINS[-1]}')
    return int(domain)


class Neighbours:
    """The look, begun when this is made and over when it is left. :meth:`refuse` waits for what it finds."""

    def __init__(self) -> None:
        from shared_control.processes import leave_with_the_parent
        from shared_control_ros.processes import node_environment
        ros_domain()
        self._environment = node_environment()
        self._process = subprocess.Popen(
            [sys.executable, '-m', __name__], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=self._environment, text=True, errors='replace', start_new_session=True,
            preexec_fn=leave_with_the_parent)

    def refuse(self) -> None:
        """Wait for the end of the look.

        Raises:
            ValueError: the nodes of a session cannot run here; the message says why, and what to do.
        """
        try:
            said, errors = self._process.communicate(timeout=GIVEN_UP_AFTER)
        except subprocess.TimeoutExpired:
            raise ValueError(f'ROS did not start within {GIVEN_UP_AFTER:.0f} s; {self._suspects()}') from None
        if self._process.returncode:
            if self._process.returncode == -signal.SIGBUS:  # LTTng, which ROS traces with, keeps a page in /dev/shm
                raise ValueError('ROS does not start: SIGBUS, as when /dev/shm is full: `df /dev/shm`, and remove what '
                                 'is left in it')
            lines = [line for line in errors.splitlines() if line.strip()] or [f'exit code {self._process.returncode}']
            raise ValueError(f'ROS does not start: {lines[-1].strip()}; {self._suspects()}')
        problem = json.loads(said.splitlines()[-1])
        if problem:
            raise ValueError(problem if 'ROS_DOMAIN_ID' in problem else f'{problem}; {self._suspects()}')

    def __enter__(self) -> 'Neighbours':
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()

    def _suspects(self) -> str:
        shown = [f'{name}={value}' for name, value in sorted(self._environment.items())
                 if name.startswith(SUSPECTS) and sys.prefix not in value]
        return f'what nodes are given: {", ".join(shown)}'


def look() -> str:
    """What is in the way of a session here; empty: nothing."""
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node
    from shared_control_ros import contract
    from shared_control_ros.interfaces import INTERFACES
    contexts = Context(), Context()
    for context in contexts:
        rclpy.init(context=context)
    me, other = (Node(f'session_looks_around_{os.getpid()}_{index}', context=context, start_parameter_services=False,
                      enable_rosout=False) for index, context in enumerate(contexts))
    began = time.monotonic()
    other.create_publisher(contract.PHASE.msg_type, other.get_name(), 1)
    while not me.count_publishers(other.get_name()):
        if time.monotonic() - began > MEETS_WITHIN:
            return 'nodes on this machine do not find each other: `shared-control doctor` looks for the reason'
        time.sleep(0.02)
    alone = (contract.JOINT_STATES, contract.EFFORT_COMMANDS, contract.BALL, contract.CLOCK, contract.HUMAN_WRENCH,
             contract.AGENT_WRENCH, contract.APPLIED_WRENCH, contract.PHASE)  # of which a graph has one publisher
    of_keys = {name for name, interface in INTERFACES.items() if contract.KEYS in interface.publishes}

    def publishers() -> set[str]:
        found = [info for topic in alone for info in me.get_publishers_info_by_topic(topic.full_name)]
        found += [info for info in me.get_publishers_info_by_topic(contract.KEYS.full_name)
                  if info.node_name in (*of_keys, UNKNOWN)]  # devices of the person's own may be there
        return {f'{info.node_namespace.rstrip("/")}/{info.node_name}' for info in found}

    there = publishers()
    while (passed := time.monotonic() - began) < LOOKS_FOR or (passed < MEETS_WITHIN and UNKNOWN in str(there)):
        time.sleep(0.05)
        there = publishers()
    for context in contexts:
        rclpy.try_shutdown(context=context)
    if there:
        return (f'{", ".join(sorted(there))} already in ROS domain {os.environ.get("ROS_DOMAIN_ID") or 0}: end '
                'that first, or set ROS_DOMAIN_ID to another number, so that the two do not disturb each other')
    return ''


if __name__ == '__main__':
    print(json.dumps(look()))
    sys.stdout.flush()
    os._exit(0)  # nothing is to be cleared up that could keep it from ending
