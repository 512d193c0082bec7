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

"""Names that two publishers share.

Each state of the one would end what the other holds, and a button that is held would be pressed again and again.
"""

import math

from .sources import REMEMBERED

AGAIN_WITHIN = 2.0
"""Numbers that fall again within this time are of two publishers; sources tell their state ten times a second, s."""


class SharedNames:
    """Finds names under which two publishers send at once, by the numbers that each gives to its messages.

    They rise. Where those of two publishers are mixed they fall again and again; when one is started anew, once.
    """

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}
        self._fell_at: dict[str, float] = {}
        self._shared_until: dict[str, float] = {}

    def is_shared(self, name: str, number: int | None, now: float) -> bool:
        """Whether two publishers use a name.

        Args:
            number: ``publication_sequence_number`` of the message that has come; None: the middleware has none.
            now: of the monotonic clock, s.
        """
        if number is None:
            return False
        before = self._numbers.pop(name, None)
        self._numbers[name] = number
        if before is not None and number <= before:
            if now - self._fell_at.get(name, -math.inf) < AGAIN_WITHIN:
                self._shared_until[name] = now + AGAIN_WITHIN
            self._fell_at[name] = now
        if len(self._numbers) > REMEMBERED:
            oldest = next(iter(self._numbers))
            for kept in (self._numbers, self._fell_at, self._shared_until):
                kept.pop(oldest, None)
        return now < self._shared_until.get(name, now)


def words_of_shared(name: str, topic: str) -> str:
    """What a person is told of it."""
    return f'two publishers call themselves {name!r} on {topic}: neither counts until each has a frame_id of its own'
