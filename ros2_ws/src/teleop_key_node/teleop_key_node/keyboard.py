"""From the bytes a terminal sends to strokes."""

import re
from collections.abc import Collection
from enum import Enum


class Stroke(Enum):
    """What a person can ask for in the terminal."""

    LEFT = 'left'
    RIGHT = 'right'
    UP = 'up'
    DOWN = 'down'
    SPACE = 'space'
    FINISH = 'finish'
    PAUSE = 'pause'
    REDRAW = 'redraw'


_LETTERS = {
    b'a': Stroke.LEFT, b'A': Stroke.LEFT, b'd': Stroke.RIGHT, b'D': Stroke.RIGHT, b' ': Stroke.SPACE,
    b'w': Stroke.UP, b'W': Stroke.UP, b's': Stroke.DOWN, b'S': Stroke.DOWN,
    b'q': Stroke.FINISH, b'Q': Stroke.FINISH, b'p': Stroke.PAUSE, b'P': Stroke.PAUSE, b'\x0c': Stroke.REDRAW}
_ARROWS = {b'A': Stroke.UP, b'B': Stroke.DOWN, b'C': Stroke.RIGHT, b'D': Stroke.LEFT}

# An arrow is ESC [ D, ESC O D (application mode) or, with Shift or Ctrl held, ESC [ 1 ; 5 D.
_TOKEN = re.compile(rb'\x1b[\[O][0-9;]*[@-~]|.', re.DOTALL)
_UNFINISHED = re.compile(rb'\x1b(?:[\[O][0-9;]*)?\Z')


class Keyboard:
    """Decodes what is typed; the rest of a sequence may come with the next bytes.

    Args:
        unknown: strokes that mean nothing here.
    """

    def __init__(self, unknown: Collection[Stroke] = (Stroke.UP, Stroke.DOWN)) -> None:
        self._unknown = unknown
        self._rest = b''

    def strokes(self, data: bytes) -> list[Stroke]:
        """The strokes in ``data``, in order. Keys that mean nothing here are passed over."""
        data = self._rest + data
        unfinished = _UNFINISHED.search(data)
        self._rest = unfinished.group() if unfinished else b''
        if unfinished:
            data = data[:unfinished.start()]
        found = (self._stroke(token) for token in _TOKEN.findall(data))
        return [stroke for stroke in found if stroke is not None and stroke not in self._unknown]

    @staticmethod
    def _stroke(token: bytes) -> Stroke | None:
        if token.startswith(b'\x1b') and len(token) > 1:
            return _ARROWS.get(token[-1:])
        return _LETTERS.get(token)
