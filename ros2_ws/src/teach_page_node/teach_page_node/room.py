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

"""Who is at the page: one teaches, the others watch."""

import asyncio
import json
import logging
from typing import Any

from fastapi import WebSocket
from shared_control.keys import count_buttons
from shared_control.sticks import DIRECTIONS

from .desk import Desk
from .history import History

log = logging.getLogger(__name__)


class Visitor:
    """A page that is open somewhere. A slow one misses pictures, and delays nobody.

    Args:
        name: what the page calls itself when it comes back after a lost connection.
    """

    def __init__(self, socket: WebSocket, name: str):
        self.socket = socket
        self.name = name
        self._words: list[str] = []
        self._picture: str | None = None
        self._news = asyncio.Event()

    def tell(self, message: dict[str, Any]) -> None:
        """Send this, whatever else there is."""
        self._words.append(json.dumps(message))
        self._news.set()

    def show(self, picture: str) -> None:
        """Send this unless a newer picture comes first."""
        self._picture = picture
        self._news.set()

    async def serve(self) -> None:
        """Send what there is to send, until the page is gone."""
        while True:
            await self._news.wait()
            self._news.clear()
            words, self._words = self._words, []
            picture, self._picture = self._picture, None
            for text in words + ([] if picture is None else [picture]):
                await self.socket.send_text(text)


class Room:
    """All visitors, and the one whose keys count.

    The first to come teaches. When the teacher goes, the others go on watching until one of them takes the seat; a
    teacher that comes back (a reload, a lost connection) has it again. A page at which nobody has done anything yet, a
    forgotten one of an earlier session that was connected first, keeps the seat from nobody.
    """

    def __init__(self, desk: Desk):
        self._desk = desk
        self._visitors: list[Visitor] = []
        self._teacher: Visitor | None = None
        self._seat_of = ''
        """The name of the page that teaches, or did last."""
        self._is_at_work = False
        """Whether somebody is at the page that teaches: its keys have come, or a command."""
        self._history: dict[str, Any] = History().message()

    @property
    def has_visitors(self) -> bool:
        """Whether a page is open."""
        return bool(self._visitors)

    async def receive(self, socket: WebSocket) -> None:
        """Serve one page from its coming to its going."""
        await socket.accept()
        visitor = Visitor(socket, socket.query_params.get('page', ''))
        self._visitors.append(visitor)
        visitor.tell({'history': self._history})
        if len(self._visitors) == 1 or (visitor.name and visitor.name == self._seat_of):
            self._seat(visitor)
        else:
            self._tell_roles()
        sender = asyncio.create_task(visitor.serve())
        try:
            while (message := await socket.receive())['type'] == 'websocket.receive':
                self._hear(visitor, message.get('text') or message.get('bytes') or '')
        finally:
            sender.cancel()
            self._leave(visitor)

    def show(self) -> None:
        """A picture for everybody."""
        picture = self._desk.look()
        history = picture.history.message()
        if history != self._history:
            self._history = history
            for visitor in self._visitors:
                visitor.tell({'history': history})
        if self._visitors:
            text = json.dumps({'picture': picture.message()})
            for visitor in self._visitors:
                visitor.show(text)

    def _seat(self, visitor: Visitor) -> None:
        if self._teacher is not None:  # its old connection, not yet known to be lost
            self._desk.let_go()
        self._teacher, self._seat_of, self._is_at_work = visitor, visitor.name, False
        self._tell_roles()

    def _leave(self, visitor: Visitor) -> None:
        self._visitors.remove(visitor)
        if visitor is self._teacher:
            self._teacher = None
            self._desk.let_go()
        self._tell_roles()

    def _tell_roles(self) -> None:
        for visitor in self._visitors:
            visitor.tell({'role': {'teaches': visitor is self._teacher,
                                   'seat_is_free': visitor is not self._teacher and not self._is_taken,
                                   'watchers': len(self._visitors) - (self._teacher is not None)}})

    @property
    def _is_taken(self) -> bool:
        return self._teacher is not None and self._is_at_work

    def _work(self) -> None:
        """Somebody is at the page that teaches."""
        if not self._is_at_work:
            self._is_at_work = True
            self._tell_roles()

    def _hear(self, visitor: Visitor, text: str | bytes) -> None:
        """What a page says; it is bytes when the page sent a binary message.

        That is ``{"keys": [0, 1, 0]}``, with ``"axes": [0.5, 0.0]`` when there is a stick, ``{"let_go": true}`` or
        ``{"do": command, "value": ...}``.
        """
        try:
            message = json.loads(text)
            if message == {'do': 'take_seat'}:
                if not self._is_taken:
                    self._seat(visitor)
                    self._work()
            elif visitor is not self._teacher:
                return
            elif 'keys' in message:
                self._desk.press(_buttons(message['keys'], count_buttons(self._desk.task.keys)),
                                 _axes(message.get('axes', [])))
                self._work()
            elif 'let_go' in message:
                self._desk.let_go()
            else:
                self._desk.do(message['do'], message.get('value'))
                self._work()
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            log.warning('dropped a message of a page: %s (%.100r)', error, text)


def _buttons(value: Any, count: int) -> list[int]:
    if not (isinstance(value, list) and len(value) == count and all(type(v) is int and v in (0, 1) for v in value)):
        raise ValueError(f'expected {count} buttons of 0 or 1')
    return value


def _axes(value: Any) -> list[float]:
    if not (isinstance(value, list) and len(value) in (0, len(DIRECTIONS))
            and all(type(v) in (int, float) and -1.0 <= v <= 1.0 for v in value)):
        raise ValueError(f'expected {len(DIRECTIONS)} axes of -1 to 1 (left, up), or none')
    return [float(v) for v in value]
