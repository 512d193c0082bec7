"""Looking into serialized messages without turning them into objects, for topics of which few messages matter."""

import struct

_STAMP = struct.Struct('<iI')
_STAMP_AT = 4
"""After the encapsulation header of CDR."""


def stamp_of(serialized: bytes) -> int:
    """Stamp of a serialized message whose first field is a Header, ns."""
    seconds, nanoseconds = _STAMP.unpack_from(serialized, _STAMP_AT)
    return seconds * 1_000_000_000 + nanoseconds
