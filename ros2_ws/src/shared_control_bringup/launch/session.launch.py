"""A session: simulator, controller, keys, agent, recorder. It ends when the agent is done.

With ``tutor:=keyboard`` the teaching screen takes the terminal of the launch, and what the nodes say goes to launch's
log folder. ``shared-control session`` does the same without launch, tests the policy and writes a report as well.
"""

import time

from launch import LaunchContext, LaunchDescription, SomeSubstitutionsType
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import EqualsSubstitution, IfElseSubstitution, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from shared_control.plugins import LEARNERS, names
from shared_control.teaching.profiles import PROFILES
from shared_control_bringup.launching import (
    common_arguments,
    end_with,
    environment,
    graph_node,
    in_namespace,
    view,
    view_argument,
)
from shared_control_learning.presets import preset


def controller(context: LaunchContext, output: SomeSubstitutionsType) -> list[Node]:
    """The controller, with the limit of the task that the preset learns."""
    limit = preset(LaunchConfiguration('preset').perform(context)).task.limit.max()
    return [graph_node('torque_ctrl_node', parameters={'moment_limit': limit}, output=output)]


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    tutor, output = LaunchConfiguration('tutor'), LaunchConfiguration('output')
    by_hand, in_browser, simulated = (EqualsSubstitution(tutor, choice) for choice in ('keyboard', 'page', 'sim'))
    seed = ParameterValue(LaunchConfiguration('seed'), value_type=int)
    said = IfElseSubstitution(by_hand, 'own_log', 'screen')
    return LaunchDescription([
        DeclareLaunchArgument('tutor', default_value='keyboard', choices=['keyboard', 'page', 'sim', 'none'],
                              description='Who teaches: you, here or in a browser, a simulated tutor, or nobody.'),
        DeclareLaunchArgument('profile', default_value='expert', choices=list(PROFILES),
                              description='Of the simulated tutor.'),
        DeclareLaunchArgument('preset', default_value='coached', choices=names(LEARNERS),
                              description='What is learned and how.'),
        DeclareLaunchArgument('episodes', default_value='0',
                              description='Teach this many, then test; 0: until somebody says that it has learned it.'),
        DeclareLaunchArgument('seed', default_value='0', description='Of ball starts, learner and simulated tutor.'),
        DeclareLaunchArgument('output', default_value=time.strftime('out/sessions/%Y-%m-%d_%H-%M-%S'),
                              description='Folder for bag/ and learner/.'),
        *common_arguments(),
        view_argument(),
        *environment(),
        in_namespace([
            graph_node('session_recorder_node', parameters={'output': PathJoinSubstitution([output, 'bag'])},
                       output=said),
            OpaqueFunction(function=controller, args=[said]),
            graph_node('panda_sim_node', parameters={'seed': seed}, output=said),
            graph_node('teleop_key_node', parameters={'screen': IfElseSubstitution(by_hand, 'auto', 'off')},
                       output=said),
            graph_node('teach_page_node', output=said, condition=IfCondition(in_browser)),
            graph_node('sim_tutor_node', parameters={'profile': LaunchConfiguration('profile'), 'seed': seed},
                       output=said, condition=IfCondition(simulated)),
            graph_node('ppo_agent_node', parameters={
                'preset': LaunchConfiguration('preset'), 'seed': seed,
                'episodes': ParameterValue(LaunchConfiguration('episodes'), value_type=int),
                'practice': ParameterValue(in_browser, value_type=bool),
                'output': PathJoinSubstitution([output, 'learner'])}, output=said),
        ]),
        view(),
        end_with('ppo_agent_node', 'teach_page_node'),
    ])
