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

"""The page of a session: where it is served, and the token of a page that is open to the network."""

import secrets
from dataclasses import dataclass
from typing import Any

from teach_page_node.address import TOKEN_VARIABLE, free_port, needs_token, page_address

from .settings import Settings

NODE = 'teach_page_node'
TOKEN = 'token'
"""Parameter of the node that no file of a session has in it."""


@dataclass(frozen=True)
class Page:
    """Chosen by the session, so that it stays the same when the node is started again."""

    host: str
    port: int
    token: str | None
    """None: the page is for this machine only."""

    @classmethod
    def choose(cls, settings: Settings, parameters: dict[str, dict[str, Any]]) -> 'Page | None':
        """The page of a session; None when it has none.

        A token in ``parameters`` is taken out of them, since they are recorded.

        Raises:
            OSError: the host is none of this machine's, or the port is in use.
        """
        token = parameters.get(NODE, {}).get(TOKEN, '')
        for values in parameters.values():  # a file may give it to all nodes
            values.pop(TOKEN, None)
        if settings.tutor != 'page':
            return None
        host, port = settings.page
        return cls(host, free_port(host, port),
                   (token or secrets.token_urlsafe(16)) if needs_token(host) else None)

    @property
    def address(self) -> str:
        """What to open in a browser."""
        return page_address(self.host, self.port, self.token)

    @property
    def environment(self) -> dict[str, dict[str, str]]:
        """Variables for the node that serves it, by its name."""
        return {NODE: {TOKEN_VARIABLE: self.token}} if self.token else {}
