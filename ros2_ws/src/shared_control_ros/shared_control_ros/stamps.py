"""Stamps as integers of nanoseconds."""

from builtin_interfaces.msg import Time


def to_ns(stamp: Time) -> int:
    """Nanoseconds of a stamp."""
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def set_ns(stamp: Time, ns: int) -> None:
    """Write ``ns`` into a stamp, in place."""
    stamp.sec, stamp.nanosec = divmod(ns, 1_000_000_000)
