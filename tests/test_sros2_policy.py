"""The SROS2 policy is what its table says, and allows every node what it does, on the running graph."""

import xml.etree.ElementTree as ET
from importlib.metadata import entry_points
from itertools import pairwise
from pathlib import Path

import pytest
import shared_control_ros
from shared_control.contract import SERVICES, TOPICS
from shared_control_bringup.waits import Waits
from shared_control_ros.sros2_policy import ENCLAVES, policy

COMMITTED = Path(shared_control_ros.__file__).parent / 'config' / 'sros2_policy.xml'
SOURCES = Path(__file__).parents[1] / 'ros2_ws' / 'src'
STAND_IN = SOURCES / 'shared_control_nodes' / 'test' / 'stand_in'
TYPES = {'/' + entry.name.removeprefix('/'): entry.type for entry in (*TOPICS, *SERVICES)}
NODES = {script.name: {} for script in entry_points(group='console_scripts') if script.name.endswith('_node')}


@pytest.fixture(scope='module')
def allowed():
    """Names by node and by what is allowed."""
    rules = {}
    for enclave in ET.fromstring(policy()).iter('enclave'):
        profile = enclave.find('profiles/profile')
        name = profile.get('node')
        assert enclave.get('path') == f'{ENCLAVES}/{name}' and profile.get('ns') == '/'
        rules[name] = {what: {absolute(child.text, name) for child in group}
                       for group in profile for what in group.attrib}
    return rules


def absolute(name, node):
    return f'/{node}/{name[2:]}' if name.startswith('~/') else '/' + name.lstrip('/')


def test_the_committed_policy_is_up_to_date():
    assert COMMITTED.read_text() == policy(), (
        f'python -m shared_control_ros.sros2_policy > {COMMITTED.relative_to(SOURCES)}')


def test_what_moves_the_robot_may_come_from_one_node_only(allowed):
    for topic, only in (('/effort_controller/commands', 'torque_ctrl_node'), ('/target_wrench', 'torque_ctrl_node'),
                        ('/human/applied_wrench', 'torque_ctrl_node'), ('/agent/applied_wrench', 'torque_ctrl_node'),
                        ('/human/target_wrench', 'teleop_key_node'), ('/agent/target_wrench', 'ppo_agent_node'),
                        ('/emergency_stop', 'operator')):
        assert [node for node, rules in allowed.items() if topic in rules['publish']] == [only]
    assert [node for node, rules in allowed.items() if '/controller/enable' in rules.get('request', ())] == [
        'operator']


def test_every_node_is_allowed_what_it_does(allowed, start_node, observer, tmp_path, monkeypatch):
    monkeypatch.setenv('PYTHONPATH', str(STAND_IN))  # of panda-python
    assert NODES.keys() == allowed.keys() - {'operator', 'session'}, 'add new nodes to shared_control_ros.interfaces'
    NODES['session_recorder_node'] = {'output': tmp_path / 'bag'}
    NODES['panda_bridge_node'] = {'hostname': 'here'}
    robots = ('panda_sim_node', 'mock_panda_node', 'panda_bridge_node')
    running = {name: start_node(name, **parameters) for name, parameters in NODES.items() if name not in robots[1:]}
    for node in running.values():
        node.wait_for_log('ready', 60.0)
    waits = Waits([], print)  # of a session
    waits.open()
    check(observer, {name: rules for name, rules in allowed.items() if name not in ('operator', *robots[1:])})
    for before, name in pairwise(robots):  # a domain has one at a time
        running[before].stop()
        running[name] = start_node(name, **NODES[name])
        check(observer, {name: allowed[name]})
    waits.close()


def check(observer, allowed):
    """What these nodes are seen to do."""
    node = observer.node
    observer.spin(lambda: set(allowed) <= set(node.get_node_names()), 120.0)
    observer.spin_for(1.0)  # the endpoints are told after the names
    for name, rules in allowed.items():
        for what, found in (('publish', node.get_publisher_names_and_types_by_node),
                            ('subscribe', node.get_subscriber_names_and_types_by_node),
                            ('reply', node.get_service_names_and_types_by_node),
                            ('request', node.get_client_names_and_types_by_node)):
            done = {entry[0] for entry in found(name, '/')}
            assert done <= rules.get(what, set()), f'{name} does what the policy does not allow it to {what}'
            assert done or what not in ('publish', 'reply'), f'{name} was not looked at'
            for entry, types in found(name, '/'):
                assert types == [TYPES.get(entry, types[0])], f'{name}: {entry} is not of the type of the contract'
