"""Joint states as arrays in the controller's order."""

import math

import numpy as np
from sensor_msgs.msg import JointState
from shared_control.robot.limits import JOINT_NAMES


class JointStateReader:
    """Picks ``panda_joint1..7`` out of a JointState by name, whatever their order."""

    def __init__(self) -> None:
        self._names: list[str] = []
        self._order: np.ndarray | None = None

    def read(self, message: JointState) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions (rad), velocities (rad/s) and efforts (N m), each (7,).

        Raises:
            ValueError: a joint or a value is missing, or a value is not finite; the message says which.
        """
        if message.name != self._names:
            self._order = self._find(message.name)
            self._names = list(message.name)
        count = len(self._names)
        fields = []
        for name, values in (('position', message.position), ('velocity', message.velocity),
                             ('effort', message.effort)):
            if len(values) != count:
                raise ValueError(f'{name} has {len(values)} values for {count} joints')
            fields.append(np.array(values) if self._order is None else np.array(values)[self._order])
        q, qd, effort = fields
        if not math.isfinite(q.sum() + qd.sum() + effort.sum()):
            raise ValueError(f'values that are not finite: position {q}, velocity {qd}, effort {effort}')
        return q, qd, effort

    @staticmethod
    def _find(names: list[str]) -> np.ndarray | None:
        missing = [name for name in JOINT_NAMES if name not in names]
        if missing:
            raise ValueError(f'no joint {missing[0]!r} among {list(names)}')
        order = np.array([names.index(name) for name in JOINT_NAMES])
        return None if list(names) == list(JOINT_NAMES) else order
