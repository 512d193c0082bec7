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

"""Parameters with ranges and choices."""

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control_ros.parameters import ParameterError, declare, passed_over_files, unknown_parameters


@pytest.fixture
def node(observer):
    return observer.node


def test_default_description_and_unit(node):
    assert declare(node, 'my_rate', 50.0, 'How often.', unit='Hz', minimum=1.0, maximum=100.0, read_only=False) == 50.0
    descriptor = node.describe_parameter('my_rate')
    assert descriptor.description == 'How often. [Hz]'
    assert descriptor.floating_point_range[0].to_value == 100.0


def test_a_range_holds_at_run_time(node):
    declare(node, 'my_rate', 50.0, 'How often.', minimum=1.0, maximum=100.0, read_only=False)
    assert not node.set_parameters([Parameter('my_rate', value=1000.0)])[0].successful
    assert node.set_parameters([Parameter('my_rate', value=10.0)])[0].successful


def test_a_default_that_is_no_choice_is_refused(node):
    with pytest.raises(ParameterError, match=r"'my_mode' has no choice 'c'.*One of: a, b"):
        declare(node, 'my_mode', 'c', 'How.', choices=('a', 'b'))


def test_parameters_are_fixed_unless_told_otherwise(node):
    declare(node, 'my_size', 3, 'How large.')
    assert not node.set_parameters([Parameter('my_size', value=4)])[0].successful


def test_a_name_with_a_slip_in_it_is_said(observer):
    given = [Parameter('moment_limt', value=5.0), Parameter('wings', value=2), Parameter('use_sim_time', value=False)]
    node = Node('given', context=observer.context, parameter_overrides=given)
    declare(node, 'moment_limit', 20.0, 'The most.')
    slip, strange = unknown_parameters(node)
    node.destroy_node()
    assert slip == "there is no parameter 'moment_limt', and it counts nothing: is 'moment_limit' meant?"
    assert "no parameter 'wings'" in strange and 'ros2 param list' in strange


@pytest.mark.parametrize(('namespace', 'section', 'is_for_it', 'is_said'), [
    ('/', 'torque_ctrl_node', True, False),
    ('/robot1', 'torque_ctrl_node', False, True),
    ('/', '/robot1/torque_ctrl_node', False, True),
    ('/robot1', '/*/torque_ctrl_node', True, False),
    ('/a/b', '/*/torque_ctrl_node', False, True),
    ('/a/b', '/**/torque_ctrl_node', True, False),
    ('/a/b', '/a/**', True, False),
    ('/', '/**', True, False),
    ('/', 'torque_control_node', False, True),
    ('/', 'torque_ctrl', False, True),
    ('/', 'panda_sim_node', False, False),
    ('/', '/robot1/*', False, False),
])
def test_a_file_that_is_passed_over_is_said(domain_id, tmp_path, namespace, section, is_for_it, is_said):
    path = tmp_path / 'my.yaml'
    path.write_text(f'"{section}": {{ros__parameters: {{limit: 5.0}}}}\nteach_page_node: {{ros__parameters: {{a: 1}}}}')
    arguments = ['--ros-args', '-r', f'__ns:={namespace}', '--params-file', str(path)]
    context = Context()
    rclpy.init(args=arguments, context=context, domain_id=domain_id)
    node = Node('torque_ctrl_node', context=context)
    lines, given = passed_over_files(node, arguments), 'limit' in node._parameter_overrides
    own = node.get_fully_qualified_name()
    node.destroy_node()
    context.try_shutdown()
    assert given == is_for_it, 'the rules are those of rcl'
    assert bool(lines) == is_said
    assert not lines or (f'{path} has no section for {own}' in lines[0] and 'teach_page_node' in lines[0])


def test_namespaces_may_be_nested_and_pipes_are_left_alone(node, tmp_path):
    path = tmp_path / 'my.yaml'
    path.write_text('robot1: {observer: {ros__parameters: {a: 1}}}')
    [line] = passed_over_files(node, ['--params-file', str(path), '--params-file', '/dev/null'])
    assert '(sections: /robot1/observer)' in line
