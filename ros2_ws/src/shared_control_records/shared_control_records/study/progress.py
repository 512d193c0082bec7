"""How far a real participant has come: ``progress.json``."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from shared_control.files import write_atomically

SCALES = {
    'mental': 'Mental demand: how much thinking, deciding and watching did it take?',
    'physical': 'Physical demand: how much physical effort did it take?',
    'temporal': 'Temporal demand: how hurried was the pace?',
    'performance': 'Performance: how well did you do what you were asked to? (0 perfect, 100 failure)',
    'effort': 'Effort: how hard did you have to work for that?',
    'frustration': 'Frustration: how discouraged, irritated or stressed were you?',
}
"""NASA-TLX (Hart and Staveland, 1988), raw: without weights, the mean of the six is the workload."""


class ProgressError(ValueError):
    """A participant's progress cannot be read; the message names the file."""


@dataclass
class Progress:
    """What a participant has done; saved after every step, so that any of it can be interrupted."""

    path: Path
    consented: str | None = None
    """When; None: not yet."""
    practised: bool = False
    taught: list[str] = field(default_factory=list)
    """Conditions whose session came to its end."""
    tlx: dict[str, dict[str, float]] = field(default_factory=dict)
    """By condition and scale, 0..100."""

    @classmethod
    def of(cls, person: Path) -> 'Progress':
        """The progress kept in a participant's folder; a fresh one when there is none.

        Raises:
            ProgressError: the file is damaged.
        """
        path = person / 'progress.json'
        try:
            return cls(path, **json.loads(path.read_text()))
        except FileNotFoundError:
            return cls(path)
        except (ValueError, TypeError) as error:
            raise ProgressError(f'{path} is damaged: {error}') from error

    def save(self) -> None:
        """Keep it."""
        content = {key: value for key, value in asdict(self).items() if key != 'path'}
        write_atomically(self.path, (json.dumps(content, indent=2) + '\n').encode())
