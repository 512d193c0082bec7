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

"""The viewers' files: everything they show is published, and in the form in which they look for it."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml
from shared_control.robot.spec_file import panda
from shared_control_nodes.view.node import MARKERS, ROBOT_DESCRIPTION
from shared_control_ros.contract import BASE_FRAME, TOPICS

VIEWS = Path(__file__).parents[1] / 'views'
TYPES = {topic.full_name: topic.msg_type for topic in (*TOPICS, MARKERS, ROBOT_DESCRIPTION)}
NUMBER = r'(double|float|u?int\d+|bool)'


def field_type(msg_type, path):
    """Type of a field given by its names; ``a[3]`` is an element of a sequence."""
    for name in path:
        name, index = re.fullmatch(r'(\w+)(\[\d+\])?', name).groups()
        kind = msg_type.get_fields_and_field_types()[name]
        if index:
            kind = re.fullmatch(r'sequence<(.+)>', kind).group(1)
        if '/' in kind:
            package, name = kind.split('/')
            msg_type = getattr(__import__(f'{package}.msg').msg, name)
    return kind


def plotjuggler_curves():
    return [curve.get('name') for curve in ET.parse(VIEWS / 'plotjuggler.xml').iter('curve')]


@pytest.mark.parametrize('curve', plotjuggler_curves())
def test_plotjuggler_curves_are_numbers_that_are_published(curve):
    topic = max((name for name in TYPES if curve.startswith(name + '/')), key=len)
    path = curve.removeprefix(topic + '/').split('/')
    if path[0] in panda().joints:  # PlotJuggler puts the joint before the field
        path = [path[1] + '[0]']
    assert re.fullmatch(NUMBER, field_type(TYPES[topic], path))


def test_foxglove_shows_what_is_published():
    layout = json.loads((VIEWS / 'foxglove.json').read_text())
    panels = layout['configById']
    scene = panels.pop('3D!scene')
    assert scene['followTf'] == BASE_FRAME
    assert set(scene['topics']) | {scene['layers']['robot']['topic']} <= set(TYPES)
    assert panels['DiagnosticSummary!nodes']['topicToRender'] in TYPES
    paths = [path['value'] for panel in panels.values() for path in panel.get('paths', [])]
    assert len(paths) == 8
    for path in paths:
        topic, *fields = path.split('.')
        assert re.fullmatch(NUMBER + '|string', field_type(TYPES[topic], fields))


def test_foxglove_places_every_panel():
    layout = json.loads((VIEWS / 'foxglove.json').read_text())

    def panels(node):
        return [node] if isinstance(node, str) else panels(node['first']) + panels(node['second'])

    assert sorted(panels(layout['layout'])) == sorted(layout['configById'])


def test_rviz_shows_what_is_published_with_the_qos_of_the_publisher():
    manager = yaml.safe_load((VIEWS / 'session.rviz').read_text())['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == BASE_FRAME
    shown = {}
    for display in manager['Displays']:
        for key in ('Topic', 'Description Topic'):
            if key in display:
                shown[display[key]['Value']] = display[key]['Durability Policy']
    assert shown == {'/robot_description': 'Transient Local', '/markers': 'Volatile'}
    for topic in (ROBOT_DESCRIPTION, MARKERS):
        assert shown[topic.full_name] == topic.qos.durability.name.replace('_', ' ').title()
