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

"""Looking into serialized messages without turning them into objects, for topics of which few messages matter."""

import struct

_STAMP = struct.Struct('<iI')
_STAMP_AT = 4
"""After the encapsulation header of CDR."""
STAMP_BYTES = slice(_STAMP_AT, _STAMP_AT + _STAMP.size)
"""Where the stamp lies in a message whose first field is a Header."""


def stamp_of(serialized: bytes | bytearray) -> int:
    """Stamp of a serialized message whose first field is a Header, ns.

    Raises:
        struct.error: there are not enough bytes.
    """
    seconds, nanoseconds = _STAMP.unpack_from(serialized, _STAMP_AT)
    return seconds * 1_000_000_000 + nanoseconds


def set_stamp(serialized: bytearray, stamp_ns: int) -> None:
    """Write the stamp of a serialized message whose first field is a Header."""
    _STAMP.pack_into(serialized, _STAMP_AT, *divmod(stamp_ns, 1_000_000_000))
