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

"""The description: complete, and every mesh it names is there."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from panda_tray_description import URDF_PATH

ROBOT = ET.parse(URDF_PATH).getroot()


def test_chain_from_base_to_tray():
    parent_of = {j.find('child').get('link'): j.find('parent').get('link') for j in ROBOT.iter('joint')}
    link, chain = 'panda_tray', []
    while link in parent_of:
        link = parent_of[link]
        chain.append(link)
    assert chain == [f'panda_link{i}' for i in range(8, -1, -1)]
    assert len(list(ROBOT.iter('link'))) == len(parent_of) + 1


def test_the_tray_is_fixed_to_the_flange():
    joint = next(j for j in ROBOT.iter('joint') if j.get('name') == 'panda_tray_joint')
    assert joint.get('type') == 'fixed' and joint.find('parent').get('link') == 'panda_link8'


@pytest.mark.parametrize('mesh', sorted({m.get('filename') for m in ROBOT.iter('mesh')}))
def test_meshes_are_there(mesh):
    prefix = 'package://panda_tray_description/'
    assert mesh.startswith(prefix)
    path = URDF_PATH.parent.parent / mesh.removeprefix(prefix)
    assert path.stat().st_size > 1000
    for line in path.open(errors='replace'):
        if line.startswith('mtllib'):
            assert (path.parent / line.split()[1]).is_file()


def test_meshes_keep_their_licence():
    assert 'Apache License' in (URDF_PATH.parent.parent / 'meshes' / 'LICENSE.txt').read_text()


def test_inertias_are_those_of_a_body():
    """Positive definite, and no principal moment larger than the sum of the others."""
    for link in ROBOT.iter('link'):
        mass = float(link.find('inertial/mass').get('value'))
        i = {k: float(v) for k, v in link.find('inertial/inertia').attrib.items()}
        if mass == 0.0:
            assert link.get('name') == 'panda_link8'
            continue
        moments = np.linalg.eigvalsh([
            [i['ixx'], i['ixy'], i['ixz']], [i['ixy'], i['iyy'], i['iyz']], [i['ixz'], i['iyz'], i['izz']]])
        assert moments[0] > 0 and moments[2] <= moments[0] + moments[1]


def test_the_ball_rolls_on_40_by_10_centimetres():
    tray = next(link for link in ROBOT.iter('link') if link.get('name') == 'panda_tray')
    boxes = {c.get('name'): (np.array(c.find('origin').get('xyz').split(), float),
                             np.array(c.find('geometry/box').get('size').split(), float))
             for c in tray.iter('collision')}
    for axis, length, walls in ((0, 0.40, ('wall at -x', 'wall at +x')), (1, 0.10, ('wall at -y', 'wall at +y'))):
        (low, low_size), (high, high_size) = (boxes[wall] for wall in walls)
        inside = (high - high_size / 2)[axis] - (low + low_size / 2)[axis]
        assert inside == pytest.approx(length)
