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

"""What is looked at before the nodes of a session start, with real nodes."""

import pytest
from shared_control_bringup.neighbours import Neighbours
from shared_control_ros import contract


def look():
    with Neighbours() as neighbours:
        neighbours.refuse()


def test_a_simulator_that_somebody_has_left_behind_is_named(start_node, domain_id):
    look()
    start_node('panda_sim_node').wait_for_log('ready')
    with pytest.raises(ValueError, match=f'/panda_sim_node already in ROS domain {domain_id}: .*ROS_DOMAIN_ID'):
        look()


def test_a_tutor_that_somebody_has_left_behind_is_named_and_a_device_is_welcome(start_node, observer):
    observer.node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
    look()
    start_node('sim_tutor_node').wait_for_log('ready')
    with pytest.raises(ValueError, match='/sim_tutor_node already in ROS domain') as error:
        look()
    assert 'observer' not in str(error.value)


@pytest.mark.parametrize(('name', 'value', 'said'), [
    ('ROS_DOMAIN_ID', 'mine', "ROS_DOMAIN_ID is 'mine'"), ('ROS_DOMAIN_ID', '233', "ROS_DOMAIN_ID is '233'")])
def test_a_variable_that_cannot_be_is_named(monkeypatch, name, value, said):
    monkeypatch.setenv(name, value)
    with pytest.raises(ValueError, match=said):
        look()


def test_nodes_that_do_not_find_each_other_are_said_with_what_may_be_to_blame(domain_id, monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    monkeypatch.delenv('FASTRTPS_DEFAULT_PROFILES_FILE')
    with pytest.raises(ValueError, match=r'do not find each other.*ROS_AUTOMATIC_DISCOVERY_RANGE=OFF'):
        look()


def test_a_python_without_ros_is_said(monkeypatch, tmp_path):
    """The process that looks is given a module of the wrong kind, as another install of ROS would."""
    (tmp_path / 'rclpy.py').write_text('raise ImportError("made for another Python")')
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    with pytest.raises(ValueError, match=r'ROS does not start: .*made for another Python; .*PYTHONPATH='):
        look()
