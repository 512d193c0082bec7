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

"""Markers of tray, ball and moments, all in the base frame: they need no transforms."""

from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from shared_control.robot.model import quaternion_of
from shared_control.scene import Box
from shared_control_ros.contract import BASE_FRAME
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

TRAY_COLOUR = ColorRGBA(r=0.25, g=0.32, b=0.42, a=1.0)
BALL_COLOUR = ColorRGBA(r=0.8, g=0.47, b=0.65, a=1.0)
MOMENT_COLOURS = {
    'human': ColorRGBA(r=0.835, g=0.369, b=0.0, a=1.0),
    'agent': ColorRGBA(r=0.0, g=0.447, b=0.698, a=1.0),
    'applied': ColorRGBA(r=0.12, g=0.16, b=0.2, a=1.0),
}
"""Those of the reports."""
METRES_PER_NEWTON_METRE = 0.03
BAR_HEIGHTS = {'human': 0.30, 'agent': 0.25, 'applied': 0.20}
"""Heights of the bars above the tray's centre, m."""


def tray_markers(position: np.ndarray, rotation: np.ndarray, boxes: Sequence[Box]) -> list[Marker]:
    """The tray at ``position`` (3,), m, turned by ``rotation`` (3, 3)."""
    turn = Quaternion(**dict(zip('xyzw', quaternion_of(rotation).tolist(), strict=True)))
    markers = []
    for number, box in enumerate(boxes):
        marker = _marker('tray', number, Marker.CUBE, TRAY_COLOUR)
        marker.pose = Pose(position=_point(position + rotation @ box.centre), orientation=turn)
        marker.scale = Vector3(**dict(zip('xyz', box.size, strict=True)))
        markers.append(marker)
    return markers


def ball_marker(position: np.ndarray, radius: float) -> Marker:
    """The ball; position (3,) and radius in m."""
    marker = _marker('ball', 0, Marker.SPHERE, BALL_COLOUR)
    marker.pose.position = _point(position)
    marker.scale = Vector3(x=2 * radius, y=2 * radius, z=2 * radius)
    return marker


_ROLLS = {3: np.array([0.0, -1.0, 0.0]), 4: np.array([1.0, 0.0, 0.0])}
"""Which way a ball rolls on a tray that a positive moment about base x (3) or y (4) has tilted."""


def moment_markers(source: str, moment: np.ndarray, axes: tuple[int, ...], tray: np.ndarray) -> list[Marker]:
    """A bar above the tray (centre ``tray``, (3,), m), to where ``moment`` rolls the ball, and its figures.

    Args:
        moment: along ``axes`` (rows of the wrench), (k,), N m; about base x and y it tilts, about others nothing rolls.
    """
    start = tray + [0.0, 0.0, BAR_HEIGHTS[source]]
    bar = _marker(f'moment {source}', 0, Marker.ARROW, MOMENT_COLOURS[source])
    roll = sum((_ROLLS.get(axis, np.zeros(3)) * value for axis, value in zip(axes, moment, strict=True)), np.zeros(3))
    bar.points = [_point(start), _point(start + METRES_PER_NEWTON_METRE * roll)]
    bar.scale = Vector3(x=0.012, y=0.024, z=0.03)  # diameters of shaft and head, length of the head
    text = _marker(f'moment {source}', 1, Marker.TEXT_VIEW_FACING, MOMENT_COLOURS[source])
    text.pose.position = _point(start + [0.0, 0.0, 0.025])
    text.scale.z = 0.025
    text.text = f'{source} {" ".join(f"{value:+.1f}" for value in moment)} N m'
    return [bar, text]


def _marker(namespace: str, number: int, kind: int, colour: ColorRGBA) -> Marker:
    marker = Marker(ns=namespace, id=number, type=kind, action=Marker.ADD, color=colour)
    marker.header.frame_id = BASE_FRAME
    marker.pose.orientation.w = 1.0
    return marker


def _point(position: np.ndarray) -> Point:
    x, y, z = position.tolist()
    return Point(x=x, y=y, z=z)
