"""One thread for learning: the same bits on any machine, and quicker for networks of this size."""

from collections.abc import Iterator
from contextlib import contextmanager

import torch


@contextmanager
def one_thread() -> Iterator[None]:
    """Let PyTorch compute in one thread, whatever ``OMP_NUM_THREADS`` says; afterwards as before.

    Sums that are split over threads are rounded otherwise, so that a seed would give another policy on another machine.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
