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

"""A recorded session once more: its bag, and viewers. Start no robot and no controller in this ROS domain.

Screens take the joints from /joint_states_throttle, which is not in bags: /joint_states is played there.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from shared_control_bringup.launching import SHARE, environment, view, view_argument


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('bag', description="The bag's folder, as in out/demo/bag."),
        DeclareLaunchArgument('rate', default_value='1.0', description='Of the wall clock.'),
        view_argument('true'),
        *environment(),
        view(),
        ExecuteProcess(
            cmd=['ros2', 'bag', 'play', LaunchConfiguration('bag'), '--rate', LaunchConfiguration('rate'),
                 '--read-ahead-queue-size', '20000',
                 '--qos-profile-overrides-path', PathJoinSubstitution([SHARE, 'bags', 'qos_overrides.yaml']),
                 '--remap', '/joint_states:=/joint_states_throttle'],
            output='screen'),
    ])
