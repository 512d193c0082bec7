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

"""What a bag has compressed, unpacked to no more than it says, and to no more than ``CHUNK_MOST``.

What it says may be wrong, by damage or on purpose: then a few kilobytes would take all memory.
"""

from dataclasses import replace

import zstandard
from lz4.frame import LZ4FrameDecompressor
from mcap import stream_reader
from mcap.data_stream import ReadDataStream
from mcap.records import Chunk

CHUNK_MOST = 256 * 2**20
"""Bytes of a chunk. Recorders write 1 MB or so, and one that holds large pictures some of them."""


class UnpackError(ValueError):
    """Something cannot be unpacked, or may not be; the message says what is wrong with it."""


class SpoiltError(UnpackError):
    """It is not what it says that it is."""


def allowed(what: str, size: int) -> int:
    """The size that a chunk or a message says it has.

    Raises:
        UnpackError: that is more than ``CHUNK_MOST``.
    """
    if size > CHUNK_MOST:
        raise UnpackError(f'{what} says that it has {size} bytes, expected {CHUNK_MOST} at the most')
    return size


def unpack(compression: str, data: bytes, size: int) -> bytes:
    """The content of a chunk that says it has ``size`` bytes.

    Raises:
        UnpackError: it has more than ``CHUNK_MOST``, or is compressed by something unknown.
        SpoiltError: it is damaged, or has another number of bytes than it says.
    """
    try:
        match compression:
            case '':
                content = data
            case 'zstd':
                content = _zstd(data, size)
            case 'lz4':
                content = LZ4FrameDecompressor().decompress(data, max_length=allowed('a chunk', size) + 1)
            case _:
                raise UnpackError(f'a chunk is compressed by {compression!r}, expected zstd or lz4')
    except (zstandard.ZstdError, RuntimeError) as error:  # lz4 has no error of its own
        raise SpoiltError(f'a chunk is damaged: {error}') from error
    if len(content) != size:
        raise SpoiltError(f'a chunk is damaged: it does not have the {size} bytes that it says')
    return content


def check_message(data: bytes) -> None:
    """Refuse a message, compressed by itself with zstd, that has more than ``CHUNK_MOST``.

    Raises:
        UnpackError: it has, or it is damaged.
    """
    try:
        size = allowed('a message', zstandard.frame_content_size(data))
        # With a size of 0 the decompressor would not look at what follows.
        whole = size and zstandard.ZstdDecompressor().decompress(
            data, max_output_size=CHUNK_MOST, allow_extra_data=False)
    except zstandard.ZstdError as error:
        raise SpoiltError(f'a message is damaged: {error}') from error
    if not whole:
        raise SpoiltError('a message is damaged: it is empty')


def _zstd(data: bytes, size: int) -> bytes:
    if zstandard.frame_content_size(data) not in (-1, size):  # the decompressor would believe it, and not ``size``
        return b''
    return zstandard.ZstdDecompressor().decompress(data, max_output_size=allowed('a chunk', size))


def _stream(chunk: Chunk, validate_crc: bool = False) -> tuple[ReadDataStream, int]:
    data = unpack(chunk.compression, chunk.data, chunk.uncompressed_size)
    return _STREAM(replace(chunk, compression='', data=data), validate_crc)


_STREAM = stream_reader.get_chunk_data_stream
# mcap believes a chunk, wherever it comes across one: also where an index points to one instead of what it is to have.
stream_reader.get_chunk_data_stream = _stream
