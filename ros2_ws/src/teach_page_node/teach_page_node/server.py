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

"""The web server of the page: NiceGUI's files, the page, and one WebSocket for pictures and keys."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import uvicorn
from fastapi import FastAPI, HTTPException, WebSocket
from fastapi.responses import FileResponse
from fastapi.staticfiles import StaticFiles
from nicegui import ui

from .address import listen, needs_token, own_token, page_address
from .desk import Desk
from .guard import Guard
from .layout import build
from .room import Room

STATIC = Path(__file__).parent / 'static'
GONE_AFTER = 5.0
"""A browser that does not answer for this long is gone, s."""
NOBODY_LOOKS = 20.0
"""With everything done and no page open for as long, the server ends, s: a page that is loaded anew is back sooner."""
LAST_WORDS = 0.3
"""How long the last picture has to arrive, s."""
RECONNECT_WITHIN = 30.0
"""NiceGUI loads the page anew when its own connection was lost for longer, s; a busy machine must not cause that."""


class PageServer:
    """Serves the page.

    Args:
        desk: what is shown, and who hears the keys.
        host: address to listen on; another than loopback's needs a token, which is made when none is given.
        port: 0 takes any that is free.
        frame_rate: pictures a second.
        token: see :class:`Guard`.

    Raises:
        OSError: the address cannot be had; the message names it.
    """

    def __init__(self, desk: Desk, host: str, port: int, frame_rate: float, token: str = ''):
        self._desk = desk
        self._period = 1.0 / frame_rate
        self._token = (token or own_token(port)) if needs_token(host) else None
        self._socket = listen(host, port)
        self._room = Room(desk)

    @property
    def address(self) -> str:
        """What to open in a browser."""
        host, port = self._socket.getsockname()[:2]
        return page_address(host, port, self._token)

    async def serve(self, stop_requested: Callable[[], bool]) -> None:
        """Serve until told to stop, by a signal or by the desk."""
        app = FastAPI(openapi_url=None)
        app.mount('/static', StaticFiles(directory=STATIC), name='static')

        @app.websocket('/live')
        async def live(websocket: WebSocket) -> None:
            await self._room.receive(websocket)

        @app.get('/session/{name}')
        async def session_file(name: str) -> FileResponse:
            path = self._desk.file(name)
            if path is None:
                raise HTTPException(404, 'there is nothing to be seen (yet)')
            return FileResponse(path)

        ui.run_with(app, root=lambda: build(self._desk.is_replay, self._desk.task, self._desk.showing),
                    title='Teach the robot', tailwind=False, favicon='⚖️',
                    binding_refresh_interval=None, show_welcome_message=False, reconnect_timeout=RECONNECT_WITHIN)
        server = uvicorn.Server(uvicorn.Config(
            Guard(app, self._token), log_level='warning', access_log=False, lifespan='on',
            ws_max_size=65536, ws_per_message_deflate=False, ws_ping_interval=GONE_AFTER, ws_ping_timeout=GONE_AFTER,
            timeout_graceful_shutdown=1))
        drawing = asyncio.create_task(self._draw(server, stop_requested))
        await server.serve(sockets=[self._socket])
        await drawing

    async def _draw(self, server: uvicorn.Server, stop_requested: Callable[[], bool]) -> None:
        loop = asyncio.get_running_loop()
        due = looked_at = loop.time()
        try:
            while not (server.should_exit or stop_requested() or self._desk.is_over):
                self._room.show()
                if self._room.has_visitors or not self._desk.is_finished:
                    looked_at = loop.time()
                elif loop.time() - looked_at > NOBODY_LOOKS:
                    break
                due = max(due + self._period, loop.time())
                await asyncio.sleep(due - loop.time())
            if self._desk.is_over:
                self._room.show()  # pages are to know that it was meant
                await asyncio.sleep(LAST_WORDS)
        finally:
            server.should_exit = True
