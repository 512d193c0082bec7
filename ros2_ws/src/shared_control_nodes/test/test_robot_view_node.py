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

"""The node beside a running simulator and controller."""

import pytest
from geometry_msgs.msg import WrenchStamped
from panda_tray_description import URDF_PATH
from shared_control_nodes.view.node import MARKERS, ROBOT_DESCRIPTION
from shared_control_ros import contract
from shared_control_ros.contract import Topic
from shared_control_ros.stamps import to_ns


@pytest.fixture(scope='class')
def graph(start_node, observer):
    for package in ('torque_ctrl_node', 'panda_sim_node', 'robot_view_node'):
        parameters = {'enabled': True} if package == 'torque_ctrl_node' else {}
        start_node(package, **parameters).wait_for_log('ready')
    return observer


def texts(array):
    """What markers say."""
    return {marker.text for marker in array.markers if marker.text}


class TestBesideTheSimulator:
    def test_a_late_joiner_gets_the_description(self, graph):
        descriptions = graph.listen(ROBOT_DESCRIPTION)
        graph.spin(lambda: descriptions, what='robot_description')
        assert descriptions[0].data == URDF_PATH.read_text()

    def test_the_ball_is_drawn_where_its_odometry_says(self, graph):
        balls, arrays = graph.listen(contract.BALL), graph.listen(MARKERS)
        graph.spin(lambda: len(arrays) >= 10 and len(balls) >= 20, what='markers')
        position_at = {to_ns(ball.header.stamp): ball.pose.pose.position for ball in balls}
        drawn = [marker for array in arrays for marker in array.markers if marker.ns == 'ball']
        both = [m for m in drawn if to_ns(m.header.stamp) in position_at]
        assert len(both) >= 5
        for marker in both:
            assert marker.pose.position == position_at[to_ns(marker.header.stamp)]

    def test_a_moment_is_shown_while_it_is_repeated_and_no_longer(self, graph):
        clocks, arrays = graph.listen(contract.CLOCK), graph.listen(MARKERS)
        publisher = graph.publisher(contract.HUMAN_WRENCH)

        def press():
            """Send the moment once more; whether it was shown."""
            if clocks:
                wrench = WrenchStamped()
                wrench.header.frame_id = contract.BASE_FRAME
                wrench.header.stamp = clocks[-1].clock
                wrench.wrench.torque.y = 5.0
                publisher.publish(wrench)
            return {'human +5.0 N m', 'applied +5.0 N m'} <= {text for array in arrays for text in texts(array)}

        graph.spin(press, what='the moment in markers')
        graph.spin(lambda: 'human +0.0 N m' in texts(arrays[-1]), what='the moment gone')

    def test_transforms_of_arm_and_ball(self, graph):
        tf2_msgs = pytest.importorskip('tf2_msgs.msg', reason='ROS from PyPI has no tf2_msgs; a ROS install has')
        messages = graph.listen(Topic('/tf', tf2_msgs.TFMessage, contract.qos(100)))
        graph.spin(lambda: messages, what='/tf')
        children = {transform.child_frame_id for transform in messages[0].transforms}
        assert children == {*(f'panda_link{i}' for i in range(1, 9)), 'panda_tray', 'ball'}
