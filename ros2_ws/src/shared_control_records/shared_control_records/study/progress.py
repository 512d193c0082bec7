"""How far a real participant has come: ``progress.json``."""

from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError
from shared_control.files import write_atomically
from shared_control_learning.wrong_content import what_is_wrong

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


class Progress(BaseModel):
    """What a participant has done; saved after every step, so that any of it can be interrupted."""

    model_config = ConfigDict(extra='forbid')

    consented: str | None = None
    """When; None: not yet."""
    practised: bool = False
    taught: list[str] = []
    """Conditions whose session came to its end."""
    tlx: dict[str, dict[str, Annotated[float, Field(ge=0.0, le=100.0)]]] = {}
    """By condition and scale, 0..100."""
    _path: Path = PrivateAttr()

    @classmethod
    def of(cls, person: Path) -> 'Progress':
        """The progress kept in a participant's folder; a fresh one when there is none.

        Raises:
            ProgressError: the file is damaged.
        """
        path = person / 'progress.json'
        try:
            progress = cls.model_validate_json(path.read_bytes())
        except FileNotFoundError:
            progress = cls()
        except ValidationError as error:
            raise ProgressError(f'{path} is damaged: {what_is_wrong(error)}') from error
        progress._path = path
        return progress

    def save(self) -> None:
        """Keep it."""
        write_atomically(self._path, (self.model_dump_json(indent=2) + '\n').encode())
