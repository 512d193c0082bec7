"""From the bytes a terminal sends to strokes."""

import re
from enum import Enum


class Stroke(Enum):
    """What a person can ask for in the terminal."""

    LEFT = 'left'
    RIGHT = 'right'
    SPACE = 'space'
    FINISH = 'finish'
    PAUSE = 'pause'
    REDRAW = 'redraw'


_LETTERS = {
    b'a': Stroke.LEFT, b'A': Stroke.LEFT, b'd': Stroke.RIGHT, b'D': Stroke.RIGHT, b' ': Stroke.SPACE,
    b'q': Stroke.FINISH, b'Q': Stroke.FINISH, b'p': Stroke.PAUSE, b'P': Stroke.PAUSE, b'\x0c': Stroke.REDRAW}

# An arrow is ESC [ D, ESC O D (application mode) or, with Shift or Ctrl held, ESC [ 1 ; 5 D.
_TOKEN = re.compile(rb'\x1b[\[O][0-9;]*[@-~]|.', re.DOTALL)
_UNFINISHED = re.compile(rb'\x1b(?:[\[O][0-9;]*)?\Z')


class Keyboard:
    """Decodes what is typed; the rest of a sequence may come with the next bytes."""

    def __init__(self) -> None:
        self._rest = b''

    def strokes(self, data: bytes) -> list[Stroke]:
        """The strokes in ``data``, in order. Keys that mean nothing here are passed over."""
        data = self._rest + data
        unfinished = _UNFINISHED.search(data)
        self._rest = unfinished.group() if unfinished else b''
        if unfinished:
            data = data[:unfinished.start()]
        found = (self._stroke(token) for token in _TOKEN.findall(data))
        return [stroke for stroke in found if stroke is not None]

    @staticmethod
    def _stroke(token: bytes) -> Stroke | None:
        if token.startswith(b'\x1b') and len(token) > 1:
            return {b'D': Stroke.LEFT, b'C': Stroke.RIGHT}.get(token[-1:])
        return _LETTERS.get(token)
