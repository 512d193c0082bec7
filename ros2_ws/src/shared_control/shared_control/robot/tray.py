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

"""The tray of a task on a robot's flange: the link of a URDF, made from the task's scene."""

from dataclasses import replace
from functools import cache
from xml.etree.ElementTree import Element, SubElement, fromstring, indent, tostring

import numpy as np
import pinocchio as pin

from ..scene import Box, Scene
from .spec import RobotSpec

_COLOURS = {False: '0.9 0.9 0.92 1', True: '0.25 0.27 0.3 1'}
"""Colours of what carries the ball, and of what is in its way; RGBA."""


def carrying(spec: RobotSpec, scene: Scene) -> RobotSpec:
    """``spec`` with the tray of ``scene`` in place of the link that its URDF has at the tool frame.

    The robot as it is, when the scene leaves the tray to it (``Scene.density``) or it carries that tray already.
    """
    if scene.density is None:
        return spec
    link = tray_link(scene, spec.tool_frame)
    return spec if link == spec.tool_link else replace(spec, tool_link=link)


def askew(spec: RobotSpec, angle: float) -> str:
    """The URDF of the robot's tool as it is when mounted askew: turned by ``angle``, rad, about its own y axis."""
    robot = fromstring(spec.description)
    link = next(link for link in robot.findall('link') if link.get('name') == spec.tool_frame)
    turn = pin.rpy.rpyToMatrix(0.0, angle, 0.0)
    for part in link:
        origin = part.find('origin')
        if origin is None:
            origin = SubElement(part, 'origin')
        origin.set('xyz', _numbers(turn @ _vector(origin, 'xyz')))
        origin.set('rpy', _numbers(pin.rpy.matrixToRpy(turn @ pin.rpy.rpyToMatrix(_vector(origin, 'rpy')))))
    return tostring(link, encoding='unicode')


@cache
def tray_link(scene: Scene, name: str) -> str:
    """The URDF of a tray's link: its boxes to see and to touch, and the inertia that they have at ``scene.density``.

    Raises:
        ValueError: the scene has no density.
    """
    mass, centre, inertia = mass_properties(scene)
    link = Element('link', name=name)
    inertial = SubElement(link, 'inertial')
    SubElement(inertial, 'origin', xyz=_numbers(centre))
    SubElement(inertial, 'mass', value=repr(float(mass)))
    SubElement(inertial, 'inertia', {
        f'i{"xyz"[row]}{"xyz"[column]}': repr(float(inertia[row, column])) for row in range(3)
        for column in range(row, 3)})
    for number, box in enumerate(scene.boxes):
        for kind in ('visual', 'collision'):
            part = SubElement(link, kind, name=f'{"obstacle" if box.is_obstacle else "tray"} {number}')
            SubElement(part, 'origin', xyz=_numbers(box.centre))
            SubElement(SubElement(part, 'geometry'), 'box', size=_numbers(box.size))
            if kind == 'visual':
                material = SubElement(part, 'material', name=f'of {part.get("name")}')
                SubElement(material, 'color', rgba=_COLOURS[box.is_obstacle])
    indent(link)
    return tostring(link, encoding='unicode')


def mass_properties(scene: Scene) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, kg; centre of mass, (3,), m; inertia about it, (3, 3), kg m^2: of homogeneous boxes, tray's frame.

    Raises:
        ValueError: the scene has no density.
    """
    if scene.density is None:
        raise ValueError('the scene has no density: its tray is part of the robot, which knows its inertia')
    masses = np.array([scene.density * np.prod(box.size) for box in scene.boxes])
    centres = np.array([box.centre for box in scene.boxes])
    mass = float(masses.sum())
    centre = masses @ centres / mass
    inertia = sum(_about(box, box_mass, centre) for box, box_mass in zip(scene.boxes, masses, strict=True))
    return mass, centre, np.asarray(inertia)


def _about(box: Box, mass: float, point: np.ndarray) -> np.ndarray:
    """Inertia of a box about a point, (3, 3): its own and Steiner's part."""
    squares = np.square(box.size)
    offset = np.array(box.centre) - point
    own = mass / 12.0 * np.diag(squares.sum() - squares)
    return own + mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def _numbers(values: tuple[float, ...] | np.ndarray) -> str:
    return ' '.join(f'{float(value):.9g}' for value in values)


def _vector(element: Element, key: str) -> np.ndarray:
    return np.array(element.get(key, '0 0 0').split(), float)
