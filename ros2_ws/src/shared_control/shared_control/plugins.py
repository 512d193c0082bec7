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

"""Tasks, worlds, learners, devices and robots by name, from this and from other people's packages.

A package adds one by an entry point of the group, under its name, and touches no file of ours (docs/how_to).
"""

from importlib.metadata import entry_points
from typing import Any

from .extras import missing

TASKS = 'shared_control.tasks'
"""Classes of tasks (:class:`shared_control.tasks.task.Task`)."""
WORLDS = 'shared_control.worlds'
"""Classes of worlds (:class:`shared_control.world.World`)."""
LEARNERS = 'shared_control.learners'
"""Functions that make a learner (:class:`shared_control_learning.learner.Learner`)."""
ROBOTS = 'shared_control.robots'
"""Paths of robots' files, or functions that return one (:mod:`shared_control.robot.spec_file`)."""
DEVICES = 'shared_control.devices'
"""Classes of devices (:class:`shared_control.teaching.device.Device`)."""


def names(group: str) -> tuple[str, ...]:
    """The names that a group has, sorted."""
    return tuple(sorted({entry_point.name for entry_point in entry_points(group=group)}))


def load(group: str, name: str) -> Any:
    """What a group has under ``name``.

    Raises:
        ValueError: there is nothing of that name; the message lists the names. Or it has another name itself, by which
            policies would look for it in vain.
        NotInstalled: what it needs is not there; the message says what to install.
    """
    kind = group.rpartition('.')[2].removesuffix('s')
    for entry_point in entry_points(group=group):
        if entry_point.name == name:
            try:
                found = entry_point.load()
            except ModuleNotFoundError as error:
                raise missing(f'the {kind} {name!r}', error) from error
            if group in (TASKS, LEARNERS) and found.name != name:
                raise ValueError(f'the {kind} {name!r} has the name {found.name!r} in {entry_point.value}, by which '
                                 'policies would look for it in vain: give it the same as its entry point')
            return found
    raise ValueError(f'no {kind} {name!r}; there are {", ".join(names(group)) or "none"}')
