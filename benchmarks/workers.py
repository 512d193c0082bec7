"""The processes of the long benchmarks, which end with whoever started them and at Ctrl-C."""

import multiprocessing
import os
from argparse import ArgumentParser
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

from shared_control.processes import begin_worker


def add_workers(parser: ArgumentParser) -> None:
    """The option ``--workers``."""
    parser.add_argument('--workers', type=int, default=os.cpu_count(), metavar='N',
                        help='processes (default: one a core)')


@contextmanager
def worker_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """So many processes. On an error or an interrupt what runs is ended, and what waits is not begun."""
    pool = ProcessPoolExecutor(workers, initializer=begin_worker, initargs=(os.getpid(),))
    try:
        yield pool
    except BaseException:
        for process in multiprocessing.active_children():  # the script has no others
            process.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
