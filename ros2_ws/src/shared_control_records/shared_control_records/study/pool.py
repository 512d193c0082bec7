"""Doing jobs in parallel: by processes of this machine, or on a Ray cluster. Both do the same list of jobs."""

import os
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, NamedTuple

from shared_control.processes import leave_with_the_parent

POLL_SECONDS = 0.2


class Outcome(NamedTuple):
    """A job that has ended."""

    name: str
    error: str | None
    """Why it failed; None when it has its result."""


def on_this_machine(folder: Path, names: Sequence[str], workers: int) -> Iterator[list[Outcome]]:
    """Do jobs in processes of their own, which end with this one, however it ends.

    Yields:
        Every now and then, what has ended since.
    """
    waiting = deque(names)
    running: dict[str, tuple[subprocess.Popen, IO[bytes]]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                name = waiting.popleft()
                running[name] = _start(folder, name)
            time.sleep(POLL_SECONDS)
            ended = [name for name, (process, _) in running.items() if process.poll() is not None]
            yield [Outcome(name, _error(*running.pop(name))) for name in ended]
    finally:
        for process, _ in running.values():
            process.kill()
            process.wait()


def on_ray(folder: Path, names: Sequence[str], address: str) -> Iterator[list[Outcome]]:
    """Do jobs on a Ray cluster, one a core; ``folder`` must be the same for all of its machines.

    Yields:
        Every now and then, what has ended since.

    Raises:
        ValueError: Ray is not installed.
        OSError: there is no cluster at ``address``.
    """
    try:
        import ray
    except ImportError as error:
        raise ValueError("Ray is not installed: pip install 'shared_control[ray]'") from error
    try:
        ray.init(address=address, log_to_driver=False, logging_level='ERROR')
    except (ConnectionError, RuntimeError, ValueError) as error:
        raise OSError(f'no Ray cluster at {address!r}: {error}') from error
    try:
        @ray.remote(num_cpus=1, max_retries=0)
        def do(name: str) -> None:
            from .folder import StudyFolder
            from .job import run_job
            run_job(StudyFolder(folder), name)

        running = {do.remote(name): name for name in names}
        while running:
            ended, _ = ray.wait(list(running), num_returns=len(running), timeout=POLL_SECONDS)
            yield [Outcome(running.pop(reference), _ray_error(ray, reference)) for reference in ended]
    finally:
        ray.shutdown()


def _start(folder: Path, name: str) -> tuple[subprocess.Popen, IO[bytes]]:
    said = tempfile.TemporaryFile()  # noqa: SIM115 - closed by _error; not in the study's folder: its disk may be full
    process = subprocess.Popen(
        [sys.executable, '-m', 'shared_control_records.study.job', str(folder), name], stdin=subprocess.DEVNULL,
        stdout=said, stderr=said, env={**os.environ, 'OMP_NUM_THREADS': '1'}, process_group=0,
        preexec_fn=leave_with_the_parent)
    return process, said


def _error(process: subprocess.Popen, said: IO[bytes]) -> str | None:
    """Why an ended process failed, by its last line; None when it did not."""
    with said:
        if process.returncode == 0:
            return None
        said.seek(0)
        lines = said.read().decode(errors='replace').strip().splitlines()
    return lines[-1] if lines else f'its process ended with code {process.returncode}'


def _ray_error(ray, reference) -> str | None:
    try:
        ray.get(reference)
    except ray.exceptions.RayError as error:
        return str(getattr(error, 'cause', None) or error).strip().splitlines()[-1]
    return None
