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

"""Decoding the 1 kHz topics of a bag, whole blocks of messages at a time.

A message decoded by itself takes 10-30 us, which makes minutes of a long session. Messages of these topics differ in
stamp and numbers only, and those stand at fixed places from the end. A block is decoded at once when its messages
have the same length and the same bytes everywhere else as the topic's first message, which was decoded in the
ordinary way and found to agree; the others are decoded one by one.
"""

from collections.abc import Callable

import numpy as np
from shared_control.contract import ANSWER_DIGITS

from .chunks import windows

Row = tuple[np.ndarray, ...]
Decode = Callable[[bytes], Row | None]
"""Decodes one message in the ordinary way; None when it is unusable."""
Layout = Callable[[int], np.dtype]
"""Where the numbers stand in a message of a given length, bytes."""

_FIRST_LABEL = 12
"""Where the label of an array's first dimension begins, after encapsulation, number of dimensions and length, bytes."""
BLOCK = 4_000
"""Messages that are decoded together; bounds the memory for undecoded ones."""


def joint_state_layout(dof: int) -> Layout:
    """Stamp at the start; at the end three sequences of ``dof`` doubles, each led by its length."""
    numbers = 8 * dof
    step = numbers + 8  # a length takes four bytes, and four more up to where a double may begin
    return lambda size: _layout(size, {
        'stamp': (4, '<i4', 2), 'q': (size - numbers - 2 * step, '<f8', dof),
        'qd': (size - numbers - step, '<f8', dof), 'effort': (size - numbers, '<f8', dof)})


def odometry_layout(size: int) -> np.dtype:
    """Stamp at the start; at the end pose and twist, each with 36 covariances behind it."""
    twist = size - 8 * (36 + 6)
    return _layout(size, {'stamp': (4, '<i4', 2), 'position': (twist - 8 * (36 + 7), '<f8', 3),
                          'velocity': (twist, '<f8', 3)})


def wrench_layout(size: int) -> np.dtype:
    """Stamp at the start, force and torque at the end."""
    return _layout(size, {'stamp': (4, '<i4', 2), 'force': (size - 48, '<f8', 3), 'torque': (size - 24, '<f8', 3)})


def command_layout(dof: int) -> Layout:
    """``dof`` doubles at the end; before them, if the command says it, the stamp that it answers as text."""
    answering = _FIRST_LABEL + ANSWER_DIGITS + 21 + 8 * dof  # end of text, size, stride, offset, length, padding
    return lambda size: _layout(size, {
        'torque': (size - 8 * dof, '<f8', dof),
        **({'answers': (_FIRST_LABEL, 'u1', ANSWER_DIGITS)} if size == answering else {})})


def _layout(size: int, fields: dict[str, tuple[int, str, int]]) -> np.dtype:
    return np.dtype({
        'names': list(fields), 'itemsize': size, 'offsets': [offset for offset, _, _ in fields.values()],
        'formats': [(kind, count) for _, kind, count in fields.values()]})


class Columns:
    """Rows of arrays as they come, a block at a time, in arrays that grow in place."""

    def __init__(self) -> None:
        self._arrays: list[np.ndarray] = []
        self._rows = 0

    def add(self, times: np.ndarray, columns: Row) -> None:
        """When the messages of a block were received, ns, and an array a field."""
        block = (times, *columns)
        if not self._arrays:
            self._arrays = [np.empty((0, *column.shape[1:]), column.dtype) for column in block]
        end = self._rows + len(times)
        for own, new in zip(self._arrays, block, strict=True):
            if len(own) < end:
                # The system moves large arrays by their pages, without copying, so that little room ahead will do.
                own.resize((max(end, len(own) * 9 // 8), *own.shape[1:]), refcheck=False)
            own[self._rows:end] = new
        self._rows = end

    def finish(self) -> list[np.ndarray]:
        """All times, and one array a field; nothing without rows. They are given up here."""
        arrays, self._arrays = self._arrays, []
        for array in arrays:
            array.resize((self._rows, *array.shape[1:]), refcheck=False)
        return arrays


class BulkTopic:
    """Decodes the messages of one topic.

    Args:
        decode: gives the fields of one message, in the order of the layout.
        layout: where they stand.
        smallest: bytes below which a message cannot have that layout.
        add: takes each block: when its messages were received, ns, and an array a field; it copies what it keeps.
    """

    def __init__(self, decode: Decode, layout: Layout, smallest: int, add: Callable[[np.ndarray, Row], None]):
        self._decode = decode
        self._layout = layout
        self._smallest = smallest
        self._add = add
        self._dtype: np.dtype | None = None
        self._pattern = np.empty(0, np.uint8)
        self._constant = np.empty(0, bool)
        self._waiting: list[bytes] = []
        self._waiting_times: list[int] = []
        self._alike: list[tuple[np.ndarray, np.ndarray]] = []
        self._count_alike = 0
        self.unusable = 0
        """Messages that could not be decoded."""

    def add(self, received_ns: int, raw: bytes) -> None:
        """One more message."""
        self._waiting.append(raw)
        self._waiting_times.append(received_ns)
        if len(self._waiting) == BLOCK:
            self._add_waiting()

    def add_all(self, times: np.ndarray, content: bytes, starts: np.ndarray, sizes: np.ndarray) -> None:
        """More messages: when they were received, ns, where in ``content`` they begin, and how long they are."""
        start = 0
        while self._dtype is None and start < len(times):
            self._learn(content[starts[start]:starts[start] + sizes[start]])
            if self._dtype is None:
                self._decode_one(times[start], content[starts[start]:starts[start] + sizes[start]])
                start += 1
        if self._dtype is None:
            return
        # Of bytes alone: numpy does not copy what lies between the fields of a structure.
        of_that_size = windows(content, np.dtype((np.void, self._dtype.itemsize)))
        for odd in (*np.flatnonzero(sizes[start:] != self._dtype.itemsize) + start, len(times)):
            if odd > start:
                self._alike.append((times[start:odd], of_that_size[starts[start:odd]]))
                self._count_alike += odd - start
            if odd < len(times):
                self._decode_alike()
                self._decode_one(times[odd], content[starts[odd]:starts[odd] + sizes[odd]])
            start = odd + 1
        if self._count_alike >= BLOCK:
            self._decode_alike()

    def finish(self) -> None:
        """Decode what waits."""
        self._add_waiting()
        self._decode_alike()

    def _add_waiting(self) -> None:
        messages, self._waiting = self._waiting, []
        times, self._waiting_times = np.array(self._waiting_times, np.int64), []
        sizes = np.array([len(message) for message in messages], np.int64)
        self.add_all(times, b''.join(messages), np.cumsum(sizes) - sizes, sizes)

    def _learn(self, raw: bytes) -> None:
        """Take ``raw`` for the pattern of the topic, if the layout fits it."""
        row = self._decode(raw)
        if row is None or len(raw) < self._smallest:
            return
        dtype = self._layout(len(raw))
        fields = np.frombuffer(raw, dtype)[0]
        assert dtype.names is not None
        if not all(np.array_equal(fields[name], value) for name, value in zip(dtype.names, row, strict=True)):
            return
        self._dtype = dtype
        self._pattern = np.frombuffer(raw, np.uint8)
        varying = np.zeros(1, dtype)
        for name in dtype.names:
            varying[name].view(np.uint8)[...] = 1
        self._constant = varying.view(np.uint8) == 0

    def _decode_alike(self) -> None:
        """Decode what has collected of messages of the pattern's length."""
        if not self._alike or self._dtype is None:
            return
        times, messages = (np.concatenate(parts) for parts in zip(*self._alike, strict=True))
        self._alike.clear()
        self._count_alike = 0
        block, content = messages.view(self._dtype), messages.view(np.uint8).reshape(len(messages), -1)
        assert block.dtype.names is not None
        alike = (content[:, self._constant] == self._pattern[self._constant]).all(axis=1)
        start = 0
        for odd in (*np.flatnonzero(~alike), len(block)):
            if odd > start:
                self._add(times[start:odd], tuple(block[name][start:odd] for name in block.dtype.names))
            if odd < len(block):
                self._decode_one(times[odd], messages[odd].tobytes())
            start = odd + 1

    def _decode_one(self, time: np.int64, raw: bytes) -> None:
        row = self._decode(raw)
        if row is None:
            self.unusable += 1
            return
        self._add(np.array([time]), tuple(value[np.newaxis] for value in row))
