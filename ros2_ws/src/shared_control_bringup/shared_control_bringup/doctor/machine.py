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

"""Checks of the machine: interpreter, packages, cores, real-time limits, shared memory, browser."""

import os
import platform
import resource
import shutil
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from shared_control_bringup.node_process import REAL_TIME_PRIORITY

from .finding import Finding, Level

PACKAGES = (
    'shared-control', 'ros-rclpy', 'ros-rmw-fastrtps-cpp', 'ros-fastrtps', 'numpy', 'pin', 'pybullet', 'mujoco-core',
    'gymnasium', 'torch', 'stable-baselines3', 'mcap', 'nicegui')
"""Distributions whose versions a report of a fault needs."""
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
SHARED_MEMORY = Path('/dev/shm')
SHARED_MEMORY_NEEDED = 32e6
"""Free bytes of /dev/shm for a browser; Docker gives a container 64 MB."""
SHARED_MEMORY_OF_ROS = 64e3
"""Free bytes without which ROS ends by SIGBUS: LTTng, which it traces with, keeps a page there."""
LOOP_PRIORITY = REAL_TIME_PRIORITY + 1
"""The highest real-time priority that a session gives (:mod:`shared_control_bringup.node_process`)."""


def versions() -> Iterator[Finding]:
    """Interpreter, system and packages."""
    system = f'Python {platform.python_version()}, {platform.system()} {platform.release()}, {platform.machine()}'
    supported = platform.system() == 'Linux' and platform.machine() == 'x86_64'
    known = platform.python_version_tuple()[:2] in (('3', '11'), ('3', '12'))
    if supported and known:
        yield Finding(Level.OK, 'system', system)
    else:
        yield Finding(Level.FAULT, 'system', system,
                      'use Linux on x86_64 with Python 3.11 or 3.12: ROS 2 from PyPI exists for nothing else')
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = 'none'
    yield Finding(Level.OK, 'packages', ', '.join(f'{name} {number}' for name, number in found.items()))


def cores() -> Iterator[Finding]:
    """Cores that this process may use, and how busy they are."""
    number, load = len(os.sched_getaffinity(0)), os.getloadavg()[0]
    text = f'{number} usable of {os.cpu_count()}, load {load:.1f}'
    if number < 2:
        yield Finding(Level.NOTE, 'cores', text, 'the 1 kHz loop wants one core of its own and the other nodes '
                      'another; on one, time may run slow')
    elif load > number:
        yield Finding(Level.NOTE, 'cores', text, 'other programs keep the cores busy: end them, or time runs slow')
    else:
        yield Finding(Level.OK, 'cores', text)


def real_time() -> Iterator[Finding]:
    """The real-time priority that this user may give a process."""
    limit = resource.getrlimit(resource.RLIMIT_RTPRIO)[0]
    text = f'ulimit -r is {"unlimited" if limit == resource.RLIM_INFINITY else limit}'
    # Root, or who has CAP_SYS_NICE, may without a limit: only trying shows it.
    if limit == resource.RLIM_INFINITY or limit >= LOOP_PRIORITY or _may_be_real_time():
        yield Finding(Level.OK, 'real-time priority', f'{text}, and the 1 kHz loop may have it')
    else:
        yield Finding(Level.NOTE, 'real-time priority', f'{text}, below {LOOP_PRIORITY}: the 1 kHz loop shares its '
                      'core with whatever else runs', "as root: echo '@realtime - rtprio 98' > "
                      '/etc/security/limits.d/realtime.conf; groupadd --force realtime; usermod -aG realtime USER; '
                      'then log in anew (Docker: --ulimit rtprio=98)')


def _may_be_real_time() -> bool:
    child = os.fork()
    if child == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(LOOP_PRIORITY))
        except OSError:
            os._exit(1)
        os._exit(0)
    return os.waitpid(child, 0)[1] == 0


def shared_memory() -> Iterator[Finding]:
    """Room in /dev/shm. Nodes talk without it, unless somebody's own DDS profile says otherwise; a browser needs it."""
    subject = str(SHARED_MEMORY)
    if not SHARED_MEMORY.is_dir() or not os.access(SHARED_MEMORY, os.W_OK):
        yield Finding(Level.NOTE, subject, 'is not there, or not writable for this user: nodes need none of it, '
                      'Chromium does', f'as root: mount -o remount,rw {subject} (or mount -t tmpfs tmpfs {subject})')
        return
    usage = shutil.disk_usage(SHARED_MEMORY)
    text = f'{usage.free / 1e6:.0f} of {usage.total / 1e6:.0f} MB free'
    remedy = (f'remove what is left in it; or, as root, mount -o remount,size=1g {subject} '
              '(Docker: --shm-size=1g, or --ipc=host)')
    if usage.free < SHARED_MEMORY_OF_ROS:
        yield Finding(Level.FAULT, subject, f'{text}: ROS does not start', remedy)
    elif usage.free < SHARED_MEMORY_NEEDED:
        yield Finding(Level.NOTE, subject, f'{text}: the nodes need none of it, Chromium does', remedy)
    else:
        yield Finding(Level.OK, subject, text)


def browser() -> Iterator[Finding]:
    """A browser for the tests of the page; a session's page opens in any."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program and shutil.which('chromedriver'):
        yield Finding(Level.OK, 'Chromium', program)
    else:
        missing = 'no chromedriver on PATH' if program else 'not on PATH'
        yield Finding(Level.NOTE, 'Chromium', f'{missing}: the page opens in any browser, its tests need this one',
                      'as root: tools/install_browser.sh')
