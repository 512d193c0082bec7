"""What a check of this machine found."""

from dataclasses import dataclass
from enum import Enum


class Level(Enum):
    """How much it matters."""

    OK = 'ok'
    NOTE = 'note'
    """A session runs, but something is slower, open to others, or not there."""
    FAULT = 'FAULT'
    """A session does not run."""


@dataclass(frozen=True)
class Finding:
    """One line of the report, and the remedy below it."""

    level: Level
    subject: str
    text: str
    remedy: str = ''

    def __str__(self) -> str:
        line = f'{self.level.value:<6} {self.subject}: {self.text}'
        return f'{line}\n         {self.remedy}' if self.remedy else line
