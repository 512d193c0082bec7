"""A task's moments in a wrench."""

from collections.abc import Iterable

from geometry_msgs.msg import Wrench

_COMPONENTS = (('force', 'x'), ('force', 'y'), ('force', 'z'), ('torque', 'x'), ('torque', 'y'), ('torque', 'z'))
"""Of a wrench (fx, fy, fz, mx, my, mz), by row."""


def set_moment(wrench: Wrench, axes: Iterable[int], moment: Iterable[float]) -> None:
    """Write ``moment`` ((k,), N m) into the rows ``axes`` (k of 0..5) of a wrench; the others stay."""
    for axis, component in zip(axes, moment, strict=True):
        part, direction = _COMPONENTS[axis]
        setattr(getattr(wrench, part), direction, float(component))
