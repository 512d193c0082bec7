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
