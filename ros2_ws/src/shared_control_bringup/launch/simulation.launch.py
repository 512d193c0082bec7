"""The simulated robot under its controller, and nobody to teach it."""

from launch import LaunchDescription
from shared_control_bringup.graph import BESIDE_A_SIMULATOR
from shared_control_bringup.launching import (
    common_arguments,
    end_with,
    environment,
    graph_node,
    in_namespace,
    view,
    view_argument,
)


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        *common_arguments(),
        view_argument(),
        *environment(),
        in_namespace([
            graph_node('torque_ctrl_node', parameters=BESIDE_A_SIMULATOR, output='screen'),
            graph_node('panda_sim_node', output='screen'),
        ]),
        view(),
        end_with(),
    ])
