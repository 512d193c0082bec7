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

"""Stamps as integers of nanoseconds."""

from builtin_interfaces.msg import Time


def to_ns(stamp: Time) -> int:
    """Nanoseconds of a stamp."""
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def robot_time(stamp_ns: int) -> int:
    """A stamp of a robot, ns, that may be counted with and named in the label of an answer.

    Raises:
        ValueError: no robot's clock can have shown it.
    """
    if stamp_ns < 0:
        raise ValueError(f"its stamp is {stamp_ns * 1e-9:.3f} s: no robot's time is negative")
    return stamp_ns


def set_ns(stamp: Time, ns: int) -> None:
    """Write ``ns`` into a stamp, in place."""
    stamp.sec, stamp.nanosec = divmod(ns, 1_000_000_000)
