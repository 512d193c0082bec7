"""How long a person waits after a session, and what it takes: report and picture of a synthetic one of 45 minutes."""

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from shared_control_testing.long_sessions import write_long_session

MINUTES = 45
ROUNDS = 3
REPORT = """
import json, sys, time
from shared_control_records.session.folder import SessionFolder
from shared_control_records.session.report import write_report
from shared_control_testing.usage import memory_bytes
started = time.perf_counter()
write_report(SessionFolder.open(sys.argv[1]))
seconds = time.perf_counter() - started
print(json.dumps([seconds, memory_bytes(peak=True) / 1e6]))
"""


def measure() -> dict[str, Any]:
    """``report_s``, median with least and most; ``report_s_per_minute`` of the bag; ``peak_mb`` of the process."""
    with tempfile.TemporaryDirectory() as folder:
        session = write_long_session(Path(folder) / 'session', MINUTES)
        rounds = [json.loads(subprocess.run([sys.executable, '-c', REPORT, str(session.path)], check=True,
                                            capture_output=True, text=True).stdout) for _ in range(ROUNDS)]
    seconds, megabytes = zip(*rounds, strict=True)
    middle = statistics.median(seconds)
    return {'minutes': MINUTES, 'report_s': round(middle, 2),
            'report_s_min_max': [round(min(seconds), 2), round(max(seconds), 2)],
            'report_s_per_minute': round(middle / MINUTES, 3), 'peak_mb': round(max(megabytes), 1)}
