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

"""Reading messages: joints by name, stamps of serialized messages."""

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from shared_control.robot.spec_file import panda
from shared_control_ros.ball_states import ball_state
from shared_control_ros.contract import BASE_FRAME
from shared_control_ros.joints import joint_positions
from shared_control_ros.serialized import set_stamp, stamp_of
from shared_control_ros.stamps import set_ns
from shared_control_ros.torque_command import TorqueBytes
from shared_control_ros.wire import WireLayout, read_message
from std_msgs.msg import Float64MultiArray


def test_joints_are_found_by_name():
    names = ['gripper', *reversed(panda().joints)]
    message = JointState(name=names, position=[9.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0])
    assert joint_positions(message, panda()).tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]


@pytest.mark.parametrize(('message', 'reason'), [
    (JointState(name=list(panda().joints[:6]), position=[0.0] * 6), 'panda_joint7'),
    (JointState(name=list(panda().joints), position=[0.0] * 6), 'panda_joint7'),
    (JointState(name=list(panda().joints), position=[0.0, np.nan, *[0.0] * 5]), 'position of panda_joint2 is nan'),
    (JointState(name=list(panda().joints), position=[*[0.0] * 6, -1e160]), 'position of panda_joint7 is -1e.160 rad'),
])
def test_unusable_joints_are_refused(message, reason):
    with pytest.raises(ValueError, match=reason):
        joint_positions(message, panda())


def ball(frame=BASE_FRAME, x=0.0, speed=0.0):
    message = Odometry()
    message.header.frame_id = frame
    message.pose.pose.position.x, message.twist.twist.linear.z = x, speed
    return message


def test_a_ball_may_fall_for_long():
    assert ball_state(ball(x=-0.5, speed=-1e5)) == ((-0.5, 0.0, 0.0), (0.0, 0.0, -1e5))


@pytest.mark.parametrize(('message', 'reason'), [
    (ball(frame='world'), "frame_id is 'world'"),
    (ball(x=np.nan), r'position\.x is nan'),
    (ball(x=-1e160), r'position\.x is -1e\+160, which no ball has: at most 1e\+09 are possible'),
    (ball(speed=np.inf), r'velocity\.z is inf'),
])
def test_a_ball_that_cannot_be_is_refused(message, reason):
    with pytest.raises(ValueError, match=reason):
        ball_state(message)


@pytest.mark.parametrize('kind', [WrenchStamped, JointState])
@pytest.mark.parametrize('stamp_ns', [0, 1_795_355_809_720_131_249])
def test_stamp_of_a_serialized_message(kind, stamp_ns):
    message = kind()
    set_ns(message.header.stamp, stamp_ns)
    assert stamp_of(serialize_message(message)) == stamp_ns


STATE = JointState(name=list(panda().joints), position=[1.0] * 7, velocity=[2.0] * 7, effort=[3.0] * 7)


def test_what_is_filled_into_the_bytes_is_in_the_message():
    data = bytearray(serialize_message(STATE))
    effort, position = WireLayout(STATE, ('effort', 'position')).views(data)
    effort[:], position[:] = range(7), np.arange(7) / 3
    set_stamp(data, 1_795_355_809_720_131_249)
    expected = JointState(
        header=STATE.header, name=STATE.name, position=(np.arange(7) / 3).tolist(), velocity=[2.0] * 7,
        effort=[float(i) for i in range(7)])
    set_ns(expected.header.stamp, 1_795_355_809_720_131_249)
    assert deserialize_message(bytes(data), JointState) == expected


def test_a_layout_fits_other_numbers_and_nothing_else():
    layout = WireLayout(STATE, ('position', 'velocity', 'effort'))
    other = JointState(name=list(panda().joints), position=[np.nan] * 7, velocity=[0.0] * 7, effort=[-1.0] * 7)
    set_ns(other.header.stamp, 5)
    assert layout.fits(serialize_message(other))
    for change in ({'name': list(panda().joints[::-1])},
                   {'position': [0.0] * 6, 'velocity': [0.0] * 8}, {'effort': []}):
        fields = {'name': other.name, 'position': other.position, 'velocity': other.velocity, 'effort': other.effort}
        assert not layout.fits(serialize_message(JointState(**{**fields, **change})))
    assert not layout.fits(b'')


def test_a_layout_learns_to_overlook_the_padding_of_another_process():
    layout = WireLayout(STATE, ('position', 'velocity', 'effort'))
    foreign = bytearray(serialize_message(STATE))
    for name in panda().joints:  # 13 bytes with the closing zero: three more up to the next length
        end = foreign.index(name.encode() + b'\0') + len(name) + 1
        foreign[end:end + 3] = bytes(255 - byte for byte in foreign[end:end + 3])
    assert deserialize_message(bytes(foreign), JointState) == STATE
    assert not layout.fits(bytes(foreign))
    assert layout.learn(STATE, bytes(foreign))
    assert layout.fits(bytes(foreign)) and layout.fits(serialize_message(STATE))
    renamed = bytes(foreign).replace(b'panda_joint4', b'panda_jointX')
    assert not layout.fits(renamed)
    assert not layout.learn(STATE, renamed + bytes(8)), 'another size is another layout'
    assert not layout.learn(deserialize_message(renamed, JointState), renamed), 'names are no padding'
    assert not layout.fits(renamed)


@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_no_torque_is_sent_that_is_not_finite(value):
    command = TorqueBytes(7)
    command.torque[:] = 1.0
    assert deserialize_message(command.answer(5), Float64MultiArray).data.tolist() == [1.0] * 7
    command.torque[3] = value
    with pytest.raises(ValueError, match='not finite'):
        command.answer(5)


def test_bytes_that_are_no_message_are_refused():
    with pytest.raises(ValueError, match='no JointState'):
        read_message(serialize_message(STATE)[:40], JointState)
