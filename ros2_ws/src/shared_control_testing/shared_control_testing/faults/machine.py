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

"""A machine whose clock is set and whose network fails, for the processes that are started with its environment.

A library that is preloaded (``machine.c``) stands between them and the C library, so nothing else on this machine
notices. Packets are lost, repeated, delayed and garbled below DDS: of what is garbled, the head alone, for the checksum
of UDP protects the rest. The clock is that of the day (``CLOCK_REALTIME``).
"""

import mmap
import os
import shutil
import struct
import subprocess
from pathlib import Path

WAYS = ('drop', 'duplicate', 'reorder', 'corrupt')
"""What can become of a packet, in the order of the plan in ``machine.c``."""
_PLAN = struct.Struct('<q4I')
_SOURCE = Path(__file__).with_name('machine.c')


class Machine:
    """Close it in the end.

    Args:
        folder: for what is compiled, once.

    Raises:
        RuntimeError: there is no C compiler.
    """

    def __init__(self, folder: Path):
        compiler = shutil.which('cc')
        if compiler is None:
            raise RuntimeError('clocks are set and packets lost by a library that cc compiles: install a C compiler')
        library, plan = folder / 'machine.so', folder / 'machine.plan'
        if not library.exists():
            subprocess.run([compiler, '-std=gnu11', '-O2', '-shared', '-fPIC', '-o', library, _SOURCE, '-ldl',
                            '-lpthread'], check=True)
        plan.write_bytes(bytes(_PLAN.size))
        with plan.open('r+b') as file:
            self._plan = mmap.mmap(file.fileno(), _PLAN.size)
        self.environment = {
            'LD_PRELOAD': ':'.join(filter(None, (str(library), os.environ.get('LD_PRELOAD')))),
            'SHARED_CONTROL_FAULTS': str(plan)}
        """Variables for a process that is to live on this machine, and for all that it starts."""
        self.clock_s = 0.0
        """How far its clock is ahead of the true one, s."""
        self._shares = dict.fromkeys(WAYS, 0)

    def set_clock(self, by_s: float) -> None:
        """Set the clock forward, or back where ``by_s`` is negative."""
        self.clock_s += by_s
        self._write()

    def fail(self, way: str, share: float) -> None:
        """Let a share of all packets, 0..1, be lost or what else ``way`` says."""
        self._shares[way] = round(1000 * share)
        self._write()

    def _write(self) -> None:
        self._plan[:] = _PLAN.pack(round(self.clock_s * 1e9), *self._shares.values())

    def close(self) -> None:
        """Leave the plan to those that still have it."""
        self._plan.close()
