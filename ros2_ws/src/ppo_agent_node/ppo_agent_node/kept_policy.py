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

"""The policy file of a session, while the last episode may still be discarded."""

from pathlib import Path

from shared_control.files import write_atomically
from shared_control_learning.learner import Learner
from shared_control_learning.policy_file import save_policy


class KeptPolicy:
    """Sees to it that an agent that is killed never goes on with an episode that the person has discarded.

    Args:
        path: of the file.
    """

    def __init__(self, path: Path):
        self._path = path
        self._without: bytes | None = None
        """Its content before the last episode; None when there was no file."""
        self._with: bytes | None = None
        """After it; None when the episode is settled."""

    def learned(self, learner: Learner) -> None:
        """An episode was learned, and may be discarded until :meth:`settle`."""
        self._without = self._path.read_bytes() if self._path.exists() else None
        save_policy(learner, self._path)
        self._with = self._path.read_bytes()

    def drop_last(self) -> None:
        """The last episode is discarded: the file is as it was before; nothing when the episode is settled."""
        if self._with is None:
            return
        if self._without is None:
            self._path.unlink(missing_ok=True)
        else:
            write_atomically(self._path, self._without)

    def keep_last(self) -> None:
        """It is not, after all."""
        if self._with is not None:
            write_atomically(self._path, self._with)

    def settle(self) -> None:
        """The next episode begins, or this one is unlearned."""
        self._without = self._with = None
