"""Tasks, worlds, learners, devices and robots by name, from this and from other people's packages.

A package adds one by an entry point of the group, under its name, and touches no file of ours (docs/how_to).
"""

from importlib.metadata import entry_points
from typing import Any

TASKS = 'shared_control.tasks'
"""Classes of tasks (:class:`shared_control.tasks.task.Task`)."""
WORLDS = 'shared_control.worlds'
"""Classes of worlds (:class:`shared_control.world.World`)."""
LEARNERS = 'shared_control.learners'
"""Functions that make a learner (:class:`shared_control_learning.learner.Learner`)."""
DEVICES = 'shared_control.devices'
"""Classes of devices (:class:`shared_control.teaching.device.Device`)."""


def names(group: str) -> tuple[str, ...]:
    """The names that a group has, sorted."""
    return tuple(sorted({entry_point.name for entry_point in entry_points(group=group)}))


def load(group: str, name: str) -> Any:
    """What a group has under ``name``.

    Raises:
        ValueError: there is nothing of that name; the message lists the names.
    """
    for entry_point in entry_points(group=group):
        if entry_point.name == name:
            return entry_point.load()
    kind = group.rpartition('.')[2].removesuffix('s')
    raise ValueError(f'no {kind} {name!r}; there are {", ".join(names(group)) or "none"}')
