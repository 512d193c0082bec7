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

"""What becomes of a session after the teaching, as whoever runs it writes it into the session's folder."""

import json
from pathlib import Path
from typing import Any

LOOK_EVERY = 0.3
"""s"""
NAME = 'ending.json'
SHOWN = ('report.html', 'picture.png')
"""Files of the session that the page serves in the end."""


class Ending:
    """Reads ``ending.json``: ``stage`` (``testing``, ``reporting``, ``over``), ``tested``, ``of``, ``successes``.

    Args:
        folder: of the session; None: there is none.
        shows_result: whether people may see what came of it.
    """

    def __init__(self, folder: Path | None, shows_result: bool):
        self._folder = folder
        self._shows_result = shows_result
        self._looked_at = -LOOK_EVERY
        self._newest: dict[str, Any] | None = None

    def look(self, now: float) -> dict[str, Any] | None:
        """The newest, at ``now`` of the monotonic clock; None while the teaching lasts."""
        if self._folder is not None and now - self._looked_at >= LOOK_EVERY:
            self._looked_at = now
            self._newest = self._read(self._folder)
        return self._newest

    def _read(self, folder: Path) -> dict[str, Any] | None:
        try:
            content = json.loads((folder / NAME).read_text(encoding='utf-8'))
            said = {'stage': str(content['stage']), 'tested': content.get('tested'), 'of': content.get('of'),
                    'successes': content.get('successes') if self._shows_result else None}
        except (OSError, ValueError, KeyError, AttributeError):
            return None  # not there (yet)
        return {**said, 'has_report': self._shows_result and all((folder / name).is_file() for name in SHOWN)}

    def file(self, name: str) -> Path | None:
        """One of ``SHOWN`` when it may be shown."""
        if self._folder is None or not self._shows_result or name not in SHOWN:
            return None
        path = self._folder / name
        return path if path.is_file() else None
