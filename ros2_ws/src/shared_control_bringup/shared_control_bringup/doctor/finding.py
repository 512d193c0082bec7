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
