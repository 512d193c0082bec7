"""One thread for learning: the same bits on any machine, and quicker for networks of this size."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_thread() -> Iterator[None]:
    """Let PyTorch compute in one thread, whatever ``OMP_NUM_THREADS`` says; afterwards as before.

    Sums that are split over threads are rounded otherwise, so that a seed would give another policy on another machine.
    """
    import torch  # late: tests of a policy and reports of them, which share this module's users, need none
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
