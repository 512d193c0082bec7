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

"""How far a real participant has come: ``progress.json``."""

from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError
from shared_control.files import write_atomically
from shared_control_learning.wrong_content import what_is_wrong


class Scale(NamedTuple):
    """One scale of the questionnaire."""

    question: str
    low: str
    """What 0 means."""
    high: str
    """What 100 means."""


SCALES = {
    'mental': Scale('Mental demand: how much thinking, deciding and watching did it take?', 'very low', 'very high'),
    'physical': Scale('Physical demand: how much physical effort did it take?', 'very low', 'very high'),
    'temporal': Scale('Temporal demand: how hurried was the pace?', 'very low', 'very high'),
    'performance': Scale('Performance: how well did you do what you were asked to?', 'perfect', 'failure'),
    'effort': Scale('Effort: how hard did you have to work for that?', 'very low', 'very high'),
    'frustration': Scale(
        'Frustration: how discouraged, irritated or stressed were you?', 'very low', 'very high'),
}
"""NASA-TLX (Hart and Staveland, 1988), raw: without weights, the mean of the six is the workload. From 0 to 100, in
steps of 5 where there are steps."""


class ProgressError(ValueError):
    """A participant's progress cannot be read; the message names the file."""


class Progress(BaseModel):
    """What a participant has done; saved after every step, so that any of it can be interrupted."""

    model_config = ConfigDict(extra='forbid')

    consented: str | None = None
    """When; None: not yet."""
    consent_sha256: str | None = None
    """SHA-256 of the text that was agreed to."""
    withdrawn: Literal['keep', 'delete'] | None = None
    """Whether the participant has withdrawn, and what then was done with what had been recorded."""
    practice: dict[str, Any] | None = None
    """What the practice before the first session came to (``practice.json``)."""
    taught: list[str] = []
    """Conditions whose session came to its end."""
    tlx: dict[str, dict[str, Annotated[float, Field(ge=0.0, le=100.0)]]] = {}
    """By condition and scale, 0..100."""
    before: dict[str, str] = {}
    """Answers to the plan's questions before the first session."""
    after: dict[str, str] = {}
    """Answers at the end."""
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
            raise ProgressError(
                f'{path} is damaged: {what_is_wrong(error)}; correct it, or take it from a back-up') from error
        progress._path = path
        return progress

    def forget(self) -> None:
        """Back to what it was before anything was recorded."""
        for name, field in type(self).model_fields.items():
            setattr(self, name, field.get_default(call_default_factory=True))

    def save(self) -> None:
        """Keep it."""
        write_atomically(self._path, (self.model_dump_json(indent=2) + '\n').encode())
