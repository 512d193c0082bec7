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

"""Joint states, and which of them go out as throttled ones."""

import numpy as np
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from shared_control_ros.joint_state_publisher import JointStatePublisher
from shared_control_ros.stamps import to_ns

MS = 1_000_000
BACK = 1000 * MS
SPEED = 2.0
"""rad/s"""


def test_throttled_joint_states_are_those_of_every_10_ms_also_where_such_a_state_was_not_seen(observer):
    states, throttled = observer.listen(contract.JOINT_STATES), observer.listen(contract.JOINT_STATES_THROTTLE)
    joints = JointStatePublisher(observer.node, panda())
    observer.spin(lambda: observer.node.count_subscribers('joint_states_throttle'))
    sent = [ms * MS for ms in (2008, 2009, 2010, 2011, 2019, 2021, 2022, 2057, 2060)]
    sent += [stamp - BACK for stamp in sent]  # the clock was set
    for stamp in sent:
        # They move at an even speed; the last joint stands still.
        joints.publish(stamp, np.array([SPEED * stamp * 1e-9] * 6 + [0.1]), np.array([SPEED] * 6 + [0.0]), np.ones(7))
    observer.spin(lambda: len(states) == len(sent) and to_ns(throttled[-1].header.stamp) == 2060 * MS - BACK)
    assert [to_ns(m.header.stamp) for m in states] == sent
    due = [2010 * MS, 2020 * MS, 2050 * MS, 2060 * MS]
    assert [to_ns(m.header.stamp) for m in throttled] == due + [stamp - BACK for stamp in due]
    for message in throttled:
        expected = [SPEED * to_ns(message.header.stamp) * 1e-9] * 6 + [0.1]
        np.testing.assert_allclose(message.position, expected, atol=1e-12)
        assert list(message.velocity) == [SPEED] * 6 + [0.0] and list(message.effort) == [1.0] * 7
