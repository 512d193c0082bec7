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

"""Joint states as arrays in the controller's order."""

import numpy as np
from sensor_msgs.msg import JointState
from shared_control.robot.possible import PossibleStates
from shared_control.robot.spec import RobotSpec
from shared_control_ros.wire import WireLayout, read_message

FIELDS = ('position', 'velocity', 'effort')


class JointStateReader:
    """Picks the robot's joints out of serialized joint states by name, whatever their order.

    States that name just these joints in this order are read as the last such one was laid out.
    """

    def __init__(self, spec: RobotSpec) -> None:
        self._joints = list(spec.joints)
        self._possible = PossibleStates(spec)
        self._layout: WireLayout | None = None

    def read(self, data: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions (rad), velocities (rad/s) and efforts (N m), each (n,).

        Raises:
            ValueError: it is no JointState, a joint or a value is missing, or a value is one that no arm has; the
                message says which.
        """
        if self._layout is not None and self._layout.fits(data):
            q, qd, effort = (view.copy() for view in self._layout.views(data))
        else:
            q, qd, effort = self._read_any(data)
        if fault := self._possible.fault(q, qd, effort):
            raise ValueError(fault)
        return q, qd, effort

    def _read_any(self, data: bytes) -> tuple[np.ndarray, ...]:
        message = read_message(data, JointState)
        order = self._find(message.name)
        count = len(message.name)
        for name in FIELDS:
            if len(getattr(message, name)) != count:
                raise ValueError(f'{name} has {len(getattr(message, name))} values for {count} joints')
        if list(message.name) == self._joints:
            self._remember(message, data)
        return tuple(np.array(getattr(message, name))[order] for name in FIELDS)

    def _remember(self, message: JointState, data: bytes) -> None:
        """What is laid out like ``data`` need not be taken apart from now on."""
        if self._layout is None or not self._layout.learn(message, data):
            self._layout = WireLayout(message, FIELDS)
            self._layout.learn(message, data)

    def _find(self, names: list[str]) -> list[int]:
        missing = [name for name in self._joints if name not in names]
        if missing:
            raise ValueError(f'no joint {missing[0]!r} among {list(names)}')
        return [names.index(name) for name in self._joints]
