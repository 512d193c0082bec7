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

"""``ros2 bag record`` of what session_recorder_node records: every topic of the contract, with its QoS.

Not with --include-unpublished-topics: a topic that has a subscriber, but no publisher yet, would go into the bag
without the QoS of its publishers, and ``ros2 bag play`` would not latch it.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from shared_control.contract import BAG_TOPICS
from shared_control_bringup.launching import SHARE, environment


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('output', default_value='bag', description="The bag's folder; must not exist yet."),
        *environment(),
        ExecuteProcess(
            cmd=['ros2', 'bag', 'record', '--storage', 'mcap', '--output', LaunchConfiguration('output'),
                 '--storage-config-file', PathJoinSubstitution([SHARE, 'bags', 'mcap_writer_options.yaml']),
                 '--qos-profile-overrides-path', PathJoinSubstitution([SHARE, 'bags', 'qos_overrides.yaml']),
                 '--topics', *(topic.full_name for topic in BAG_TOPICS)],
            output='screen'),
    ])
