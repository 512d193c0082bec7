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

"""Viewers beside a running graph or bag: transforms and markers, RViz, a door for Foxglove."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from shared_control.robot.spec_file import panda
from shared_control_bringup.launching import (
    RESPAWN_DELAY,
    SHARE,
    common_arguments,
    environment,
    graph_node,
    in_namespace,
)


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    joints = LaunchConfiguration('joint_states')
    clock = {'use_sim_time': ParameterValue(LaunchConfiguration('use_sim_time'), value_type=bool)}
    return LaunchDescription([
        *common_arguments(),
        DeclareLaunchArgument('joint_states', default_value='joint_states_throttle',
                              description='The topic of joint states; a bag has joint_states only.'),
        DeclareLaunchArgument('use_sim_time', default_value='true', description='false with a real robot.'),
        DeclareLaunchArgument('rviz', default_value='true', description='Start RViz.'),
        DeclareLaunchArgument('foxglove', default_value='false',
                              description='Start foxglove_bridge on ws://127.0.0.1:8765 for Foxglove.'),
        *environment(),
        in_namespace([
            Node(package='robot_state_publisher', executable='robot_state_publisher',
                 parameters=[{'robot_description': panda().urdf.read_text(encoding='utf-8')}, clock],
                 remappings=[('joint_states', joints)], respawn=True, respawn_delay=RESPAWN_DELAY),
            graph_node('robot_view_node', parameters={'arm': False, **clock},
                       remappings=[('joint_states_throttle', joints)]),
            Node(package='rviz2', executable='rviz2',
                 arguments=['-d', PathJoinSubstitution([SHARE, 'views', 'session.rviz'])], parameters=[clock],
                 remappings=[('/robot_description', 'robot_description'), ('/markers', 'markers')],
                 condition=IfCondition(LaunchConfiguration('rviz'))),
            Node(package='foxglove_bridge', executable='foxglove_bridge',
                 parameters=[{'address': '127.0.0.1', 'port': 8765}, clock],
                 condition=IfCondition(LaunchConfiguration('foxglove'))),
        ]),
    ])
