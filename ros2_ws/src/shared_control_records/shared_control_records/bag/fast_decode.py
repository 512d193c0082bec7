"""Decoding the 1 kHz topics of a bag, whole blocks of messages at a time.

A message decoded by itself takes 10-30 us, which makes minutes of a long session. Messages of these topics differ in
stamp and numbers only, and those stand at fixed places from the end. A block is decoded at once when its messages
have the same length and the same bytes everywhere else as the topic's first message, which was decoded in the
ordinary way and found to agree; the others are decoded one by one.
"""

from collections.abc import Callable

import numpy as np
from shared_control.contract import ANSWER_DIGITS

Row = tuple[np.ndarray, ...]
Decode = Callable[[bytes], Row | None]
"""Decodes one message in the ordinary way; None when it is unusable."""
Layout = Callable[[int], np.dtype]
"""Where the numbers stand in a message of a given length, bytes."""

_FIRST_LABEL = 12
"""Where the label of an array's first dimension begins, after encapsulation, number of dimensions and length, bytes."""
BLOCK = 20_000
"""Messages that are decoded together; bounds the memory for undecoded ones."""


def joint_state_layout(dof: int) -> Layout:
    """Stamp at the start; at the end three sequences of ``dof`` doubles, each led by its length."""
    numbers = 8 * dof
    step = numbers + 8  # a length takes four bytes, and four more up to where a double may begin
    return lambda size: _layout(size, {
        'stamp': (4, '<i4', 2), 'q': (size - numbers - 2 * step, '<f8', dof),
        'qd': (size - numbers - step, '<f8', dof), 'effort': (size - numbers, '<f8', dof)})


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
    """Rows of arrays as they come, a block at a time."""

    def __init__(self) -> None:
        self._times: list[np.ndarray] = []
        self._blocks: list[Row] = []

    def add(self, times: np.ndarray, columns: Row) -> None:
        """When the messages of a block were received, ns, and an array a field."""
        self._times.append(times)
        self._blocks.append(columns)

    def finish(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """All times, and one array a field; none without rows. The blocks are given up, so that no two copies stay."""
        if not self._times:
            return np.empty(0, np.int64), []
        columns = [list(parts) for parts in zip(*self._blocks, strict=True)]
        self._blocks.clear()
        joined = []
        while columns:
            joined.append(np.concatenate(columns.pop(0)))
        times = np.concatenate(self._times)
        self._times.clear()
        return times, joined


class BulkTopic:
    """Decodes the messages of one topic.

    Args:
        decode: gives the fields of one message, in the order of the layout.
        layout: where they stand.
        smallest: bytes below which a message cannot have that layout.
        add: takes each block: when its messages were received, ns, and an array a field.
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
        self.unusable = 0
        """Messages that could not be decoded."""

    def add(self, received_ns: int, raw: bytes) -> None:
        """One more message."""
        self._waiting.append(raw)
        self._waiting_times.append(received_ns)
        if len(self._waiting) == BLOCK:
            self._decode_waiting()

    def finish(self) -> None:
        """Decode what waits."""
        self._decode_waiting()

    def _decode_waiting(self) -> None:
        messages, self._waiting = self._waiting, []
        times, self._waiting_times = np.array(self._waiting_times, np.int64), []
        start = 0
        while start < len(messages):
            end = start + 1
            if self._dtype is None:
                self._learn(messages[start])
            if self._dtype is not None and len(messages[start]) == self._dtype.itemsize:
                while end < len(messages) and len(messages[end]) == self._dtype.itemsize:
                    end += 1
                self._decode_alike(times[start:end], messages[start:end], self._dtype)
            else:
                self._decode_one(times[start], messages[start])
            start = end

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

    def _decode_alike(self, times: np.ndarray, messages: list[bytes], dtype: np.dtype) -> None:
        """Decode messages of the pattern's length."""
        block = np.frombuffer(b''.join(messages), dtype)
        content = block.view(np.uint8).reshape(len(block), dtype.itemsize)
        alike = (content[:, self._constant] == self._pattern[self._constant]).all(axis=1)
        assert dtype.names is not None
        start = 0
        for odd in (*np.flatnonzero(~alike), len(block)):
            if odd > start:
                self._add(times[start:odd], tuple(block[name][start:odd].copy() for name in dtype.names))
            if odd < len(block):
                self._decode_one(times[odd], messages[odd])
            start = odd + 1

    def _decode_one(self, time: np.int64, raw: bytes) -> None:
        row = self._decode(raw)
        if row is None:
            self.unusable += 1
            return
        self._add(np.array([time]), tuple(value[np.newaxis] for value in row))
