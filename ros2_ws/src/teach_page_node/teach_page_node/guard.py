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

"""Who may speak to the page's server.

A server on the loopback interface is still within reach of every web page that the person has open: a foreign page can
open a WebSocket to it, get there under a name of its own (DNS rebinding), or show it in an invisible frame, which would
take the teacher's seat and what is pressed. So the names of host and origin are looked at, no other page may frame it,
and who opens the server to the network needs a token.
"""

import hashlib
import secrets
from urllib.parse import parse_qs

from shared_control.hosts import OWN_FRAMES_ONLY, is_loopback
from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send


class Guard:
    """ASGI middleware.

    Args:
        app: what is guarded.
        token: None: serve this machine only. Otherwise whoever has it is let in: once as ``?token=``, then by a cookie.
    """

    def __init__(self, app: ASGIApp, token: str | None):
        self._app = app
        self._token = token
        # Browsers keep one cookie of a name for all ports of a host: each server has a name of its own.
        self._cookie = f'teach_page_{hashlib.sha256((token or "").encode()).hexdigest()[:12]}'

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let in or refuse one request."""
        if scope['type'] not in ('http', 'websocket'):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, self._with_headers(scope, send))
        elif scope['type'] == 'websocket':
            await send({'type': 'websocket.close', 'code': 1008, 'reason': refusal})
        else:
            await PlainTextResponse(refusal, status_code=403)(scope, receive, send)

    def _refusal(self, scope: Scope) -> str | None:
        headers = Headers(scope=scope)
        host = headers.get('host', '')
        if self._token is None and not is_loopback(host):
            return f'this page is served to this machine only, not as {host!r}'
        origin = headers.get('origin')
        if origin is not None and origin.partition('://')[2] != host:
            return f'pages of {origin!r} may not speak to this one'
        if self._token is not None and not any(
                secrets.compare_digest(given.encode(), self._token.encode()) for given in self._given(scope, headers)):
            return 'the address must end with the ?token=... that the session printed'
        return None

    def _given(self, scope: Scope, headers: Headers) -> list[str]:
        # Other programs on this host set cookies, too, and not all are as http.cookies wants them.
        cookies = (part.strip().partition('=') for part in headers.get('cookie', '').split(';'))
        return _query_tokens(scope) + [value for name, _, value in cookies if name == self._cookie]

    def _with_headers(self, scope: Scope, send: Send) -> Send:
        headers = dict(OWN_FRAMES_ONLY)
        if self._token is not None and _query_tokens(scope):
            headers['Set-Cookie'] = f'{self._cookie}={self._token}; HttpOnly; SameSite=Strict; Path=/'

        async def send_with_headers(message: Message) -> None:
            if message['type'] == 'http.response.start':
                answer = MutableHeaders(scope=message)
                for name, value in headers.items():
                    answer.append(name, value)
            await send(message)
        return send_with_headers


def _query_tokens(scope: Scope) -> list[str]:
    return parse_qs(scope.get('query_string', b'').decode('latin-1')).get('token', [])
