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

"""Joint states by name."""

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from shared_control.robot.spec_file import panda
from torque_ctrl_node.joint_states import JointStateReader


def message(names=panda().joints, position=None, velocity=0.1, effort=0.2):
    count = len(names)
    position = [float(i) for i in range(count)] if position is None else position
    return JointState(name=list(names), position=position, velocity=[velocity] * count, effort=[effort] * count)


def data(*arguments, **values):
    return serialize_message(message(*arguments, **values))


def test_order_follows_the_names_not_the_indices():
    reader = JointStateReader(panda())
    q, _, _ = reader.read(data(('finger', *reversed(panda().joints))))
    np.testing.assert_array_equal(q, [7, 6, 5, 4, 3, 2, 1])
    for _ in range(2):  # as any, and as it is known to be laid out
        np.testing.assert_array_equal(reader.read(data())[0], range(7))
    np.testing.assert_array_equal(reader.read(data(panda().joints[::-1]))[0], range(6, -1, -1))


@pytest.mark.parametrize(('bad', 'named'), [
    (data(panda().joints[:6]), 'panda_joint7'),
    (data(panda().joints, [0.0] * 5), 'position has 5 values'),
    (data(panda().joints, [0.0] * 6 + [float('nan')]), 'position of panda_joint7 is nan'),
    (data(velocity=1e160), 'velocity of panda_joint1 is 1e.160 rad/s'),
    (data(effort=1000.0), 'effort of panda_joint1 is 1000 N m'),
    (data()[:60], 'no JointState'),
    (b'', 'no JointState'),
], ids=['a joint missing', 'positions missing', 'not finite', 'too fast', 'too strong', 'cut', 'empty'])
def test_what_is_missing_is_named(bad, named):
    reader = JointStateReader(panda())
    for _ in range(2):
        with pytest.raises(ValueError, match=named):
            reader.read(bad)
        reader.read(data())
