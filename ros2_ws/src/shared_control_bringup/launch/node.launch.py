"""One node of the graph alone, with the parameters of a session, started again when it dies."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from shared_control_bringup.launching import common_arguments, end_with, environment, graph_node, in_namespace

NODES = [
    'panda_sim_node', 'mock_panda_node', 'panda_bridge_node', 'torque_ctrl_node', 'teleop_key_node', 'ppo_agent_node',
    'sim_tutor_node', 'session_recorder_node', 'robot_view_node', 'teach_page_node']


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('node', choices=NODES, description='Its package and executable.'),
        *common_arguments(),
        *environment(),
        in_namespace([graph_node(LaunchConfiguration('node'), output='screen')]),
        end_with('ppo_agent_node'),
    ])
