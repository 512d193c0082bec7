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

"""One node of the graph alone, with the parameters of a session, started again when it dies.

The controller starts disabled here, and again when it has died: a person calls controller/enable.
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from shared_control_bringup.graph import ALL_NODES, ALONE
from shared_control_bringup.launching import common_arguments, end_with, environment, graph_node, in_namespace


def start_node(context: LaunchContext) -> list[Node]:
    """The node that the argument names."""
    name = LaunchConfiguration('node').perform(context)
    return [graph_node(name, parameters=ALONE.get(name), output='screen')]


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('node', choices=list(ALL_NODES), description='Its name.'),
        *common_arguments(),
        *environment(),
        in_namespace([OpaqueFunction(function=start_node)]),
        end_with('ppo_agent_node'),
    ])
