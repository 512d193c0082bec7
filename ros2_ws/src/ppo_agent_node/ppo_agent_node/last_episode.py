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

"""The end of the teaching that somebody has asked for, kept beside the policy."""

import json
from contextlib import suppress
from pathlib import Path

from shared_control.files import write_atomically

LAST_EPISODE_NAME = 'last_episode.json'
"""Name of the file in a learner's folder, until all is done that was to be done after the teaching."""


class LastEpisode:
    """With which episode the teaching ends, since somebody has asked for that; an agent that is killed knows it again.

    Args:
        path: of the file; None: nothing is kept.
        wanted: the parameters that say how long is taught. When they are others than they were, so is what is wanted
            now, and the file does not count.

    Raises:
        ValueError: there is a file that cannot be used; the message names it.
    """

    def __init__(self, path: Path | None, wanted: dict[str, float]):
        self._path, self._wanted = path, wanted
        self.number = self._kept()
        """Its number; 0: the teaching is over; None: nobody has asked."""

    def _kept(self) -> int | None:
        if self._path is None:
            return None
        try:
            kept = json.loads(self._path.read_text(encoding='utf-8'))
            return int(kept['last_episode']) if kept['wanted'] == self._wanted else None
        except FileNotFoundError:
            return None
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            raise ValueError(f'cannot use {self._path} ({error!r}): remove it to go on teaching') from error

    def set(self, number: int) -> None:
        """The teaching ends when that many episodes are learned; 0: it is over."""
        self.number = number
        if self._path is not None:
            content = json.dumps({'last_episode': number, 'wanted': self._wanted})
            with suppress(OSError):  # a full disk is an error at the episode's end
                write_atomically(self._path, content.encode())

    def forget(self) -> None:
        """It was taken back, or all is done that was to be done after it."""
        self.number = None
        if self._path is not None:
            self._path.unlink(missing_ok=True)

    def is_learned(self, episodes: int) -> bool:
        """Whether the teaching is over after so many learned episodes."""
        return self.number is not None and episodes >= self.number
