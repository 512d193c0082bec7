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

"""What a process has used, as the kernel counts it."""

import os
from pathlib import Path


def cpu_seconds(process: int | str = 'self') -> float:
    """CPU time of a process (its id) so far, s."""
    fields = Path(f'/proc/{process}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def memory_bytes(process: int | str = 'self', peak: bool = False) -> int:
    """Memory of a process (its id), or the most that it ever had.

    Not ``ru_maxrss``, in which a process begins with what the one that started it had.
    """
    name = 'VmHWM:' if peak else 'VmRSS:'
    lines = Path(f'/proc/{process}/status').read_text().splitlines()
    return int(next(line.split()[1] for line in lines if line.startswith(name))) * 1024
