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

"""The SROS2 policy of the graph, from its interfaces: one enclave a node, and nobody may do what is not his.

    python -m shared_control_ros.sros2_policy > policy.xml
    ros2 security generate_artifacts --keystore-root-path keystore --policy-files policy.xml

The second line needs a ROS install with sros2; docs/how_to/security.md goes on from there.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable

from .contract import Topic
from .interfaces import INTERFACES, Interface

ENCLAVES = '/shared_control'
OF_EVERY_NODE = Interface(
    publishes=('/rosout', '/parameter_events'),
    subscribes=('/parameter_events', '/clock'),
    serves=tuple(f'~/{name}' for name in (
        'describe_parameters', 'get_parameter_types', 'get_parameters', 'get_type_description', 'list_parameters',
        'set_parameters', 'set_parameters_atomically')))


def policy() -> str:
    """The policy, XML of version 0.2.0, for a graph without a namespace."""
    root = ET.Element('policy', version='0.2.0')
    enclaves = ET.SubElement(root, 'enclaves')
    for name, interface in INTERFACES.items():
        enclave = ET.SubElement(enclaves, 'enclave', path=f'{ENCLAVES}/{name}')
        profile = ET.SubElement(ET.SubElement(enclave, 'profiles'), 'profile', ns='/', node=name)
        allowed = {
            ('topics', 'publish'): (*OF_EVERY_NODE.publishes, *interface.publishes),
            ('topics', 'subscribe'): (*OF_EVERY_NODE.subscribes, *interface.subscribes),
            ('services', 'reply'): (*OF_EVERY_NODE.serves, *interface.serves),
            ('services', 'request'): interface.calls,
        }
        for (kind, what), names in allowed.items():
            _allow(profile, kind, what, names)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding='unicode') + '\n'


def _allow(profile: ET.Element, kind: str, what: str, names: Iterable[Topic | str]) -> None:
    plain = sorted({name.name if isinstance(name, Topic) else name for name in names})
    if plain:
        rules = ET.SubElement(profile, kind, {what: 'ALLOW'})
        for name in plain:
            ET.SubElement(rules, kind.removesuffix('s')).text = name


if __name__ == '__main__':
    print(policy(), end='')
