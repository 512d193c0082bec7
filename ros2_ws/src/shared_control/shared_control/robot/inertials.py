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

"""Other inertias for the links of a URDF: what a controller may wrongly take its robot for."""

from importlib.resources import files
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import yaml

from .spec import RobotSpec


def with_masses_times(spec: RobotSpec, factor: float) -> str:
    """The robot's URDF with the masses and inertias of all links but the tool ``factor`` times what they are."""
    robot = ElementTree.fromstring(spec.description)
    for link in _links(robot, spec):
        for number in (*link.findall('inertial/mass'), *link.findall('inertial/inertia')):
            for key, value in number.items():
                number.set(key, repr(factor * float(value)))
    return ElementTree.tostring(robot, encoding='unicode')


def with_fer_inertials(spec: RobotSpec) -> str:
    """The Panda's URDF with the inertias that franka_description gives for this arm (``specs/fer_inertials.yaml``).

    Raises:
        ValueError: the robot is no Panda.
    """
    inertials = yaml.safe_load((files(__package__) / 'specs' / 'fer_inertials.yaml').read_text(encoding='utf-8'))
    robot = ElementTree.fromstring(spec.description)
    links = {link.get('name'): link for link in _links(robot, spec)}
    for name, numbers in inertials.items():
        link = links.get(f'panda_{name}')
        if link is None:
            raise ValueError(f'{spec.urdf} has no link panda_{name}: these inertias are those of a Panda')
        for old in link.findall('inertial'):
            link.remove(old)
        inertial = SubElement(link, 'inertial')
        SubElement(inertial, 'origin', xyz=numbers['xyz'])
        SubElement(inertial, 'mass', value=repr(numbers['mass']))
        SubElement(inertial, 'inertia', {f'i{key}': repr(value) for key, value in numbers['inertia'].items()})
    return ElementTree.tostring(robot, encoding='unicode')


def _links(robot: Element, spec: RobotSpec) -> list[Element]:
    return [link for link in robot.findall('link') if link.get('name') != spec.tool_frame]
