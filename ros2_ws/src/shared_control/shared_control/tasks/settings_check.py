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

"""Whether the numbers that a task can be set to make sense."""

from collections.abc import Iterable

LARGEST = 1e6
"""The bound of any number: beyond it products are no longer finite, and it is a slip or ill will."""
SMALLEST = 1e-9
"""The least of numbers above 0: something is divided by them."""
SECONDS_MAX = 3600.0
"""The longest episode, s."""
MOMENT_MAX = 1000.0
"""N m; an arm's torques have limits of their own."""

_RANGES = {
    'above 0': (SMALLEST, LARGEST),
    'of at least 0': (0.0, LARGEST),
    'of at most 0': (-LARGEST, 0.0),
    'of either sign': (-LARGEST, LARGEST),
    'of seconds': (SMALLEST, SECONDS_MAX),
    'of N m': (SMALLEST, MOMENT_MAX),
}


def check_numbers(expected: str, numbers: Iterable[tuple[str, float]]) -> None:
    """Check named numbers against a range.

    Args:
        expected: ``above 0``, ``of at least 0``, ``of at most 0``, ``of either sign``, ``of seconds``: the length of an
            episode, or ``of N m``: a moment above 0.
        numbers: what is checked.

    Raises:
        ValueError: one lies outside; the message names it.
    """
    low, high = _RANGES[expected]
    for name, value in numbers:
        if not low <= value <= high:
            raise ValueError(f'{name} is {value}, expected a finite number {expected}, {low:g} to {high:g}')
