"""A stick as the human's device: as far as it is held, so large is the moment."""

from collections.abc import Sequence

import numpy as np
from shared_control import Key, Task

DEAD_BAND = 0.1
"""Of a stick's way: what is less is rest."""
STICK_AXES = ((Key.LEFT, 0, 1.0), (Key.UP, 1, 1.0))
"""The key that a stick stands for, its axis in a Joy, and the sign of that axis when it is held to that side."""


class Stick:
    """A :class:`shared_control.Device`: a stick held to the left gives what the left key gives, and so on.

    Args:
        task: which key moves which axis.
        keystroke: not used: a stick has no presses.
        limit: the moment about each axis with the stick held all the way, N m.
    """

    def __init__(self, task: Task, keystroke: float, limit: float):
        self._sticks = [(axis, sign, *task.keys[key]) for key, axis, sign in STICK_AXES if key in task.keys]
        self._size = len(task.axes)
        self._limit = limit
        self._held: dict[str, np.ndarray] = {}

    @property
    def moment(self) -> np.ndarray:
        """Of all sources together, (k,), N m."""
        total = sum(self._held.values(), np.zeros(self._size))
        return np.clip(total, -self._limit, self._limit)

    def update(self, source: str, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """See Device."""
        expected = 1 + max((axis for axis, *_ in self._sticks), default=-1)
        values = np.asarray(axes, float)
        if len(values) < expected or not (np.abs(values[:expected]) <= 1.0).all():
            raise ValueError(f'expected {expected} axes of -1 to 1 or more, got {list(axes)}')
        moment = np.zeros(self._size)
        for axis, stick_sign, index, sign in self._sticks:
            moment[index] += sign * stick_sign * self._limit * beyond_dead_band(values[axis])
        self._held[source] = moment
        return bool(moment.any())

    def forget(self, source: str) -> None:
        """See Device."""
        self._held.pop(source, None)

    def release(self) -> None:
        """See Device. A stick that is still held counts again with its next state."""
        self._held.clear()


def beyond_dead_band(value: float) -> float:
    """A stick's value, -1..1, as 0 within the dead band and from 0 on beyond it."""
    return float(np.sign(value)) * max(abs(value) - DEAD_BAND, 0.0) / (1.0 - DEAD_BAND)
