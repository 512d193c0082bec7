"""A recorded session once more: its bag, and viewers. Start nothing else in this ROS domain."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from shared_control_bringup.launching import environment, view, view_argument


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('bag', description="The bag's folder, as in out/demo/bag."),
        DeclareLaunchArgument('rate', default_value='1.0', description='Of the wall clock.'),
        view_argument('true'),
        *environment(),
        view(joint_states='joint_states'),
        ExecuteProcess(
            cmd=['ros2', 'bag', 'play', LaunchConfiguration('bag'), '--rate', LaunchConfiguration('rate')],
            output='screen'),
    ])
