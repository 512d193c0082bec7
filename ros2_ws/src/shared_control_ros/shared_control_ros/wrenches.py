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

"""A moment in a wrench message: which components hold it, and what a usable message is."""

import numpy as np
from geometry_msgs.msg import WrenchStamped
from shared_control.tasks.balance import BALANCE
from shared_control.wrench import COMPONENTS

from .contract import BASE_FRAME

LARGEST = 1000.0
"""N m, and N of a push. Nobody means more, ten times what a full action is worth in the thesis; the sum is limited to
far less, but each part is recorded and learned from."""


def base_wrench(frame: str = BASE_FRAME) -> WrenchStamped:
    """A wrench of zero in the base's ``frame``, to be filled in."""
    wrench = WrenchStamped()
    wrench.header.frame_id = frame
    return wrench


def set_moment(wrench: WrenchStamped, moment: np.ndarray, axes: tuple[int, ...] = BALANCE.axes) -> None:
    """Write the moment along a task's axes, (k,), N m, in place."""
    for row, value in zip(axes, moment.tolist(), strict=True):
        part, component = COMPONENTS[row]
        setattr(getattr(wrench.wrench, part), component, value)


def moment_of(wrench: WrenchStamped, axes: tuple[int, ...] = BALANCE.axes, frame: str = BASE_FRAME) -> np.ndarray:
    """The moment along a task's axes in the base's ``frame``, (k,), N m.

    Raises:
        ValueError: the wrench is given in another frame than the base's, or a component is not finite or beyond
            ``LARGEST``; the message says which.
    """
    if wrench.header.frame_id != frame:
        raise ValueError(f'frame_id is {wrench.header.frame_id!r}, expected {frame!r}')
    values = []
    for row in axes:
        part, component = COMPONENTS[row]
        value = getattr(getattr(wrench.wrench, part), component)
        if not abs(value) <= LARGEST:  # nor NaN
            raise ValueError(f'{part}.{component} is {value}')
        values.append(value)
    return np.array(values)


def not_shared(wrench: WrenchStamped, axes: tuple[int, ...]) -> str:
    """Which component is not zero though it counts nothing, since the task does not share it; empty: none is."""
    for row, (part, component) in enumerate(COMPONENTS):
        value = getattr(getattr(wrench.wrench, part), component)
        if value and row not in axes:
            shared = ', '.join('.'.join(COMPONENTS[axis]) for axis in axes)
            return f'{part}.{component} is {value} and counts nothing: the task shares {shared}'
    return ''
