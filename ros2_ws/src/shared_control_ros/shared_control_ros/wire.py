"""Messages of which only numbers change, as the bytes that travel.

rclpy makes a C structure of a message field by field, names of joints and all, and an object of what it receives: for
a JointState 15 us to publish and 24 us to take, 4 us and 3 us for its bytes. At 1 kHz that is a part of the loop worth
having. Whatever looks different is read in the ordinary way.
"""

import copy
from collections.abc import Sequence
from typing import Any

import numpy as np
from rclpy.serialization import deserialize_message, serialize_message

from .serialized import STAMP_BYTES


class WireLayout:
    """Where the arrays of a message lie among its bytes.

    Args:
        message: one that is as all are, but for its stamp and for the values in its arrays.
        arrays: the names of its ``float64[]`` fields.
    """

    def __init__(self, message: Any, arrays: Sequence[str]):
        marked = copy.deepcopy(message)
        marks = {name: 1e3 * number + np.arange(len(getattr(message, name))) for number, name in enumerate(arrays, 1)}
        for name, values in marks.items():
            setattr(marked, name, values.tolist())
        data = serialize_message(marked)
        self._size = len(data)
        self._arrays = [(data.index(values.tobytes()), len(values)) for values in marks.values()]
        changing = [slice(start, start + 8 * count) for start, count in self._arrays]
        if hasattr(message, 'header'):
            changing.append(STAMP_BYTES)
        self._fixed = []
        begin = 0
        for part in sorted([*changing, slice(len(data), len(data))], key=lambda part: part.start):
            self._fixed.append((slice(begin, part.start), data[begin:part.start]))
            begin = part.stop

    def fits(self, data: bytes) -> bool:
        """Whether ``data`` is such a message."""
        return len(data) == self._size and all(data[part] == expected for part, expected in self._fixed)

    def views(self, data: bytes | bytearray) -> list[np.ndarray]:
        """The arrays, in the order of their names, as they lie in ``data``: writable where ``data`` is."""
        return [np.frombuffer(data, np.float64, count, start) for start, count in self._arrays]


def read_message(data: bytes, message_type: type) -> Any:
    """The message in ``data``.

    Raises:
        ValueError: there is no such message in it.
    """
    try:
        return deserialize_message(data, message_type)
    except RuntimeError as error:
        raise ValueError(f'{len(data)} bytes that are no {message_type.__name__}: {error}') from error
