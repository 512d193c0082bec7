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
