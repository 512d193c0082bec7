"""Joint states by name."""

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from shared_control.robot.limits import JOINT_NAMES
from torque_ctrl_node.joint_states import JointStateReader


def message(names=JOINT_NAMES, position=None):
    count = len(names)
    position = [float(i) for i in range(count)] if position is None else position
    return JointState(name=list(names), position=position, velocity=[0.1] * count, effort=[0.2] * count)


def test_order_follows_the_names_not_the_indices():
    reader = JointStateReader()
    q, _, _ = reader.read(message(('finger', *reversed(JOINT_NAMES))))
    np.testing.assert_array_equal(q, [7, 6, 5, 4, 3, 2, 1])
    np.testing.assert_array_equal(reader.read(message())[0], range(7))


@pytest.mark.parametrize(('bad', 'named'), [
    (message(JOINT_NAMES[:6]), 'panda_joint7'),
    (message(position=[0.0] * 5), 'position has 5 values'),
    (message(position=[0.0] * 6 + [float('nan')]), 'not finite'),
])
def test_what_is_missing_is_named(bad, named):
    with pytest.raises(ValueError, match=named):
        JointStateReader().read(bad)
