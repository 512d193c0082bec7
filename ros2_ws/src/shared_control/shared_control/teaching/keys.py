"""From key presses to the human's moment M_yh (3.4)."""

from collections.abc import Sequence
from enum import IntEnum

KEYSTROKE = 5.0
"""N m a press: 0.05 of the action times 100 N m (3.4 and appendix)."""

HUMAN_MOMENT_LIMIT = 10.0
"""Bound of |M_yh|, N m."""


class Key(IntEnum):
    """The three keys; the value is the button's index in ``/human/keys``."""

    LEFT = 0
    RIGHT = 1
    SPACE = 2


class KeyMoment:
    """M_yh as the keys leave it: left adds a step, right takes one away, space sets zero.

    Left is positive: the tray's +x side tips down, and the ball rolls to +x, the left of every picture.

    Args:
        step: of one press, N m.
        limit: bound of |M_yh|, N m.
    """

    def __init__(self, step: float = KEYSTROKE, limit: float = HUMAN_MOMENT_LIMIT):
        self._step = step
        self._limit = limit
        self.m_y = 0.0
        """N m"""

    def press(self, key: Key) -> None:
        """One press."""
        if key is Key.SPACE:
            self.m_y = 0.0
        else:
            change = self._step if key is Key.LEFT else -self._step
            self.m_y = min(max(self.m_y + change, -self._limit), self._limit)

    def release(self) -> None:
        """The person is gone: zero."""
        self.m_y = 0.0


class KeyPresses:
    """Finds presses (rising edges) in the button states that one source of keys repeats."""

    def __init__(self) -> None:
        self._down = [False] * len(Key)

    def update(self, buttons: Sequence[int]) -> list[Key]:
        """The keys that went down since the last state.

        Raises:
            ValueError: fewer than three buttons, or a button that is neither 0 nor 1.
        """
        if len(buttons) < len(Key):
            raise ValueError(f'expected {len(Key)} buttons (left, right, space), got {len(buttons)}')
        if any(buttons[key] not in (0, 1) for key in Key):
            raise ValueError(f'expected buttons of 0 or 1 (left, right, space), got {list(buttons[:len(Key)])}')
        pressed = [key for key in Key if buttons[key] and not self._down[key]]
        self._down = [bool(buttons[key]) for key in Key]
        return pressed
