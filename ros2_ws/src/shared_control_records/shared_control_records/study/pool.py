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

"""Doing jobs in parallel: by processes of this machine, or on a Ray cluster. Both do the same list of jobs."""

import multiprocessing
import os
from collections import deque
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import NamedTuple

from shared_control.processes import begin_worker

POLL_SECONDS = 0.2


class Outcome(NamedTuple):
    """A job that has ended."""

    name: str
    error: str | None
    """Why it failed; None when it has its result."""


def on_this_machine(folder: Path, names: Sequence[str], workers: int) -> Generator[list[Outcome], None, None]:
    """Do jobs in processes of their own, which end with this one, however it ends.

    Yields:
        Every now and then, what has ended since.
    """
    waiting = deque(names)
    running: dict[Future, tuple[str, ProcessPoolExecutor]] = {}
    free: list[ProcessPoolExecutor] = []
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                name = waiting.popleft()
                pool = free.pop() if free else _process()
                running[pool.submit(_do, folder, name)] = name, pool
            ended, _ = wait(running, POLL_SECONDS, FIRST_COMPLETED)
            outcomes = []
            for future in ended:
                name, pool = running.pop(future)
                error = future.exception()
                if isinstance(error, BrokenProcessPool):
                    pool.shutdown()
                else:
                    free.append(pool)
                outcomes.append(Outcome(name, _reason(error)))
            yield outcomes
    finally:
        for process in multiprocessing.active_children():  # the command has no others
            process.kill()
        for pool in [*free, *(pool for _, pool in running.values())]:
            pool.shutdown()


def on_ray(folder: Path, names: Sequence[str], address: str) -> Generator[list[Outcome], None, None]:
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
        raise ValueError('Ray is not installed: pip install ray') from error
    try:
        ray.init(address=address, log_to_driver=False, logging_level='ERROR')
    except (ConnectionError, RuntimeError, ValueError) as error:
        raise OSError(f'no Ray cluster at {address!r}: {error}') from error
    try:
        do = ray.remote(num_cpus=1, max_retries=0)(_do)
        running = {do.remote(folder, name): name for name in names}
        while running:
            ended, _ = ray.wait(list(running), num_returns=len(running), timeout=POLL_SECONDS)
            yield [Outcome(running.pop(reference), _ray_error(ray, reference)) for reference in ended]
    finally:
        ray.shutdown()


def _process() -> ProcessPoolExecutor:
    """A pool of one process: one that is killed breaks its pool, and the others are to go on."""
    return ProcessPoolExecutor(1, multiprocessing.get_context('spawn'), begin_worker, (os.getpid(),))


def _do(folder: Path, name: str) -> None:
    from .folder import StudyFolder
    from .job import run_job
    run_job(StudyFolder(folder), name)


def _reason(error: BaseException | None) -> str | None:
    """Why a job failed, in a line; None when it did not."""
    if error is None:
        return None
    if isinstance(error, BrokenProcessPool):
        return 'its process was killed, or crashed; it may have been out of memory'
    return (str(error).strip().splitlines() or [type(error).__name__])[-1]


def _ray_error(ray, reference) -> str | None:
    try:
        ray.get(reference)
    except ray.exceptions.RayError as error:
        return _reason(getattr(error, 'cause', None) or error)
    return None
