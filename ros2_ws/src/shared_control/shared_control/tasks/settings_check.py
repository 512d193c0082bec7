"""Whether the numbers that a task can be set to make sense."""

import math
from collections.abc import Iterable

_RANGES = {
    'above 0': lambda value: 0.0 < value < math.inf,
    'of at least 0': lambda value: 0.0 <= value < math.inf,
    'of at most 0': lambda value: -math.inf < value <= 0.0,
}


def check_numbers(expected: str, numbers: Iterable[tuple[str, float]]) -> None:
    """Check named numbers against a range: ``above 0``, ``of at least 0`` or ``of at most 0``, and finite.

    Raises:
        ValueError: one lies outside; the message names it.
    """
    for name, value in numbers:
        if not _RANGES[expected](value):
            raise ValueError(f'{name} is {value}, expected a finite number {expected}')
