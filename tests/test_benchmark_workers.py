"""The processes of the long benchmarks."""

import os
import signal
import subprocess
import sys

import pytest

SCRIPT = """
import time
from workers import worker_pool

with worker_pool(2) as pool:
    begun = [pool.submit(time.sleep, 0.0 if number < 2 else 600.0) for number in range(8)]
    begun[1].result()
    print('busy', *(process.pid for process in pool._processes.values()), flush=True)
    begun[-1].result()
"""


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_they_end_with_the_script_and_begin_nothing_more(number, load_benchmark, wait_until):
    folder = os.path.dirname(load_benchmark('workers').__file__)
    script = subprocess.Popen(
        [sys.executable, '-c', SCRIPT], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        env={**os.environ, 'PYTHONPATH': folder})
    word, *workers = script.stdout.readline().split()
    assert word == 'busy' and len(workers) == 2
    script.send_signal(number)
    assert script.wait(60) == -number
    script.stdout.close()
    wait_until(lambda: not any(os.path.exists(f'/proc/{worker}') for worker in workers), 'the end of the workers')
