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

    def add(self, episode_return: float, share: float | None) -> None:
        """An episode has ended."""
        self.returns.append(episode_return)
        self.shares.append(share)

    def message(self) -> dict[str, Any]:
        """For the browser; None for what is not finite, which JSON cannot say."""
        return {'returns': [_rounded(value, 2) for value in self.returns],
                'shares': [_rounded(value, 4) for value in self.shares]}


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None or not math.isfinite(value) else round(value, digits)
