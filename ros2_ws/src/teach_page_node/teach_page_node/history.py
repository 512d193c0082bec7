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

"""The episodes so far, for the charts."""

import math
from dataclasses import dataclass, field
from typing import Any


@dataclass
class History:
    """Return and human share of each taught episode, in order."""

    returns: list[float] = field(default_factory=list)
    shares: list[float | None] = field(default_factory=list)
    """0..1; None where it is not known any more: the page came later."""

    last_counts: bool = True
    """Whether the last of them has not been discarded."""

    def clear(self) -> None:
        """The count begins anew."""
        self.returns.clear()
        self.shares.clear()

    def add(self, episode_return: float, share: float | None) -> None:
        """An episode has ended; the one before is gone for good if it was discarded."""
        if not self.last_counts:
            del self.returns[-1:], self.shares[-1:]
        self.last_counts = True
        self.returns.append(episode_return)
        self.shares.append(share)

    def message(self) -> dict[str, Any]:
        """For the browser; None for what is not finite, which JSON cannot say."""
        until = len(self.returns) - (not self.last_counts)
        return {'returns': [_rounded(value, 2) for value in self.returns[:until]],
                'shares': [_rounded(value, 4) for value in self.shares[:until]]}


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None or not math.isfinite(value) else round(value, digits)
