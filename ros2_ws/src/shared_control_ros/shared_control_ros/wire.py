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

    CDR aligns numbers, and what is between them is whatever was in the sender's memory: every process has its own
    padding, which :meth:`learn` learns to overlook.

    Args:
        message: one that is as all are, but for its stamp and for the values in its arrays.
        arrays: the names of its ``float64[]`` fields.
        text: a piece of text in it that changes, too, but not in length.
    """

    def __init__(self, message: Any, arrays: Sequence[str], text: bytes = b''):
        self._names = arrays
        self._blank = self._blanked(message)
        marked = copy.deepcopy(message)
        marks = {name: 1e3 * number + np.arange(len(getattr(message, name))) for number, name in enumerate(arrays, 1)}
        for name, values in marks.items():
            setattr(marked, name, values.tolist())
        data = serialize_message(marked)
        self._size = len(data)
        self._arrays = [(data.index(values.tobytes()), len(values)) for values in marks.values()]
        mask = bytearray(b'\xff' * self._size)
        for start, count in self._arrays:
            mask[start:start + 8 * count] = bytes(8 * count)
        if hasattr(message, 'header'):
            mask[STAMP_BYTES] = bytes(STAMP_BYTES.stop - STAMP_BYTES.start)
        start = data.index(text)
        self.text = slice(start, start + len(text))
        """Where the text lies in a message that fits."""
        mask[self.text] = bytes(len(text))
        # A single integer: bytes are masked and compared within a microsecond.
        self._mask = _integer(mask)
        self._fixed = _integer(data) & self._mask

    def fits(self, data: bytes) -> bool:
        """Whether ``data`` is such a message."""
        return len(data) == self._size and _integer(data) & self._mask == self._fixed

    def learn(self, message: Any, data: bytes) -> bool:
        """Overlook the padding of ``data``, which ``message`` was read from, from now on.

        Returns: whether it has this layout: whether it differs in stamp, values and padding alone.
        """
        if len(data) != self._size or self._blanked(message) != self._blank:
            return False
        self._mask &= ~(_integer(data) ^ self._fixed)
        self._fixed &= self._mask
        return True

    def _blanked(self, message: Any) -> Any:
        """A copy without stamp and values."""
        blank = copy.deepcopy(message)
        for name in self._names:
            setattr(blank, name, [0.0] * len(getattr(message, name)))
        if hasattr(message, 'header'):
            blank.header.stamp = type(message.header.stamp)()
        return blank

    def views(self, data: bytes | bytearray) -> list[np.ndarray]:
        """The arrays, in the order of their names, as they lie in ``data``: writable where ``data`` is."""
        return [np.frombuffer(data, np.float64, count, start) for start, count in self._arrays]


def _integer(data: bytes | bytearray) -> int:
    return int.from_bytes(data, 'little')


def read_message(data: bytes, message_type: type) -> Any:
    """The message in ``data``.

    Raises:
        ValueError: there is no such message in it.
    """
    try:
        return deserialize_message(data, message_type)
    except RuntimeError as error:
        raise ValueError(f'{len(data)} bytes that are no {message_type.__name__}: {error}') from error
