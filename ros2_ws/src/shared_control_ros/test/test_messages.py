"""Reading messages: joints by name, stamps of serialized messages."""

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from shared_control.robot.limits import JOINT_NAMES
from shared_control_ros.joints import joint_positions
from shared_control_ros.serialized import stamp_of
from shared_control_ros.stamps import set_ns


def test_joints_are_found_by_name():
    names = ['gripper', *reversed(JOINT_NAMES)]
    message = JointState(name=names, position=[9.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0])
    assert joint_positions(message).tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]


@pytest.mark.parametrize(('message', 'reason'), [
    (JointState(name=list(JOINT_NAMES[:6]), position=[0.0] * 6), 'panda_joint7'),
    (JointState(name=list(JOINT_NAMES), position=[0.0] * 6), 'panda_joint7'),
    (JointState(name=list(JOINT_NAMES), position=[np.nan] * 7), 'not finite'),
])
def test_unusable_joints_are_refused(message, reason):
    with pytest.raises(ValueError, match=reason):
        joint_positions(message)


@pytest.mark.parametrize('kind', [WrenchStamped, JointState])
@pytest.mark.parametrize('stamp_ns', [0, 1_795_355_809_720_131_249])
def test_stamp_of_a_serialized_message(kind, stamp_ns):
    message = kind()
    set_ns(message.header.stamp, stamp_ns)
    assert stamp_of(serialize_message(message)) == stamp_ns
