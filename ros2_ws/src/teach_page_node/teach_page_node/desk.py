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

"""What the page's server needs from whoever stands behind it: a running graph, or a recorded session."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from shared_control.tasks.task import Task

from .picture import Picture
from .showing import Showing


class Desk(Protocol):
    """A live lesson or a replay."""

    is_replay: bool
    task: Task
    """What is taught."""
    showing: Showing
    """What people are shown besides what moves."""
    is_over: bool
    """The server is to end."""

    @property
    def is_finished(self) -> bool:
        """Everything is done: the server is there for those who still look."""

    def file(self, name: str) -> Path | None:
        """A file of the session that people may see by now."""

    def look(self) -> Picture:
        """What is to be seen now; called once a picture."""

    def press(self, buttons: list[int], axes: Sequence[float] = ()) -> None:
        """The teacher's hands; again and again while nothing changes.

        Args:
            buttons: in the order of ``Key``, 0 or 1.
            axes: of a stick, to the left and up, -1..1; empty: the page has none.
        """

    def let_go(self) -> None:
        """The teacher has gone, or looks elsewhere: M_yh = 0."""

    def do(self, command: str, value: Any) -> None:
        """A button of the page.

        Raises:
            ValueError: there is no such command, or the value does not fit it.
        """
