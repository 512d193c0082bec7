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

"""Dots as text, 2 x 4 to a character."""

import numpy as np

_BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], dtype=np.uint8)
"""The bit of each dot, by row and column in its cell, as braille characters number them."""
_UPPER, _LOWER = 0x1B, 0xE4


def _ascii(mask: int) -> str:
    upper, lower = (mask & _UPPER).bit_count(), (mask & _LOWER).bit_count()
    if upper + lower >= 6:
        return '#'
    if upper and lower:
        return '=' if upper + lower >= 4 else ':'
    if upper:
        return '"' if upper >= 3 else "'"
    return ' .._='[lower]


_BRAILLE_CELLS = np.array([ord(' '), *range(0x2801, 0x2900)], dtype='<u4')
_ASCII_CELLS = np.array([ord(_ascii(mask)) for mask in range(256)], dtype='<u4')


def to_lines(dots: np.ndarray, unicode: bool) -> list[str]:
    """Text of a picture of dots, (4 * rows, 2 * columns), bool: braille characters, or a likeness in ASCII."""
    rows, columns = dots.shape[0] // 4, dots.shape[1] // 2
    cells = dots.reshape(rows, 4, columns, 2).transpose(0, 2, 1, 3)
    masks = (cells * _BITS).sum(axis=(2, 3), dtype=np.uint8)
    table = _BRAILLE_CELLS if unicode else _ASCII_CELLS
    return [row.tobytes().decode('utf-32-le') for row in table[masks]]
