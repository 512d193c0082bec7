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

"""What is drawn, and where."""

import numpy as np
import pytest
from shared_control.tasks.balance import BALANCE
from shared_control_nodes.view.markers import METRES_PER_NEWTON_METRE, ball_marker, moment_markers, tray_markers
from visualization_msgs.msg import Marker

TRAY = np.array([-0.485, 0.0, 0.908])


def test_the_tray_is_drawn_as_the_boxes_of_the_task():
    boxes = BALANCE.scene.boxes
    assert len(boxes) == 5  # a plate and four walls
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for marker, box in zip(tray_markers(TRAY, quarter, boxes), boxes, strict=True):
        position, centre = marker.pose.position, box.centre
        np.testing.assert_allclose(
            [position.x, position.y, position.z], TRAY + [-centre[1], centre[0], centre[2]], atol=1e-12)
        assert marker.pose.orientation.z == pytest.approx(np.sqrt(0.5))
        assert (marker.scale.x, marker.scale.y, marker.scale.z) == box.size


def test_the_ball_has_its_diameter():
    assert ball_marker(TRAY, 0.015).scale.x == pytest.approx(0.03)


@pytest.mark.parametrize('m_y', [5.0, -2.5, 0.0])
def test_a_moment_points_to_where_the_ball_rolls(m_y):
    bar, text = moment_markers('human', np.array([m_y]), (4,), TRAY)
    assert bar.points[1].x - bar.points[0].x == pytest.approx(METRES_PER_NEWTON_METRE * m_y)
    assert (bar.points[0].y, bar.points[0].z) == (bar.points[1].y, bar.points[1].z)
    assert text.text == f'human {m_y:+.1f} N m'


def test_two_moments_are_one_arrow_in_the_plane():
    bar, text = moment_markers('agent', np.array([5.0, -2.5]), (3, 4), TRAY)
    along = [getattr(bar.points[1], axis) - getattr(bar.points[0], axis) for axis in 'xyz']
    assert along == pytest.approx([-2.5 * METRES_PER_NEWTON_METRE, -5.0 * METRES_PER_NEWTON_METRE, 0.0])
    assert text.text == 'agent +5.0 -2.5 N m'


def test_a_viewer_can_tell_all_markers_apart():
    markers = [*tray_markers(TRAY, np.eye(3), BALANCE.scene.boxes), ball_marker(TRAY, 0.015)]
    for source in ('human', 'agent', 'applied'):
        markers += moment_markers(source, np.ones(1), (4,), TRAY)
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)
    assert {marker.header.frame_id for marker in markers} == {'panda_link0'}
    assert {marker.action for marker in markers} == {Marker.ADD}
    assert all(marker.color.a == 1.0 for marker in markers)
