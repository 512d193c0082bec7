"""The episodes so far, for the charts."""

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
        """For the browser."""
        return {'returns': [round(value, 2) for value in self.returns],
                'shares': [None if value is None else round(value, 4) for value in self.shares]}
