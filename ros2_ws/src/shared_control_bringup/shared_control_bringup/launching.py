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

"""What the launch files are made of. Needs ``launch`` and ``launch_ros``, which a ROS install has and PyPI has not."""

import os
from typing import Any

from launch import Action, LaunchContext, SomeSubstitutionsType
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    RegisterEventHandler,
    SetEnvironmentVariable,
    Shutdown,
    UnsetEnvironmentVariable,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events.process import ProcessExited
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from shared_control_ros.processes import node_environment, node_module

from .node_process import UNUSABLE
from .parameters import DEFAULTS

RESPAWN_DELAY = 1.0
"""s"""
SHARE = FindPackageShare('shared_control_bringup')


def common_arguments() -> list[DeclareLaunchArgument]:
    """Arguments of every launch file that starts nodes of the graph."""
    return [
        DeclareLaunchArgument('params_file', default_value=str(DEFAULTS),
                              description='ROS parameters of all nodes, laid over the defaults.'),
        DeclareLaunchArgument('namespace', default_value='', description='Of all nodes and topics but /clock and /tf.'),
    ]


def view_argument(default: str = 'false') -> DeclareLaunchArgument:
    """``view``: for launch files that can show what they start."""
    return DeclareLaunchArgument(
        'view', default_value=default, description='Also start robot_state_publisher, robot_view_node and RViz.')


def environment() -> list[Action]:
    """What :func:`shared_control_ros.processes.node_environment` changes in the environment of the shell."""
    wanted = node_environment()
    return [*(SetEnvironmentVariable(name, value) for name, value in wanted.items() if os.environ.get(name) != value),
            *(UnsetEnvironmentVariable(name) for name in os.environ.keys() - wanted.keys())]


def graph_node(name: str, *, parameters: dict[str, Any] | None = None, **options: Any) -> Node:
    """A node of the graph: the executable ``name`` of whichever package has it, started again when it dies.

    The file is laid over the defaults, and ``parameters`` over the file; ``options`` go to ``launch_ros.actions.Node``.
    """
    # A bare string would be read as YAML: a folder called 7 would become a number.
    given = {name: ParameterValue(value, value_type=str) if isinstance(value, str) else value
             for name, value in (parameters or {}).items()}
    files: list[Any] = [str(DEFAULTS), LaunchConfiguration('params_file')]
    return Node(
        package=node_module(name).partition('.')[0], executable=name, parameters=files + ([given] if given else []),
        respawn=True, respawn_delay=RESPAWN_DELAY, **options)


def in_namespace(actions: list[Action]) -> GroupAction:
    """These actions in the namespace of the argument ``namespace``."""
    return GroupAction([PushRosNamespace(LaunchConfiguration('namespace')), *actions])


def view(**arguments: SomeSubstitutionsType) -> IncludeLaunchDescription:
    """``view.launch.py`` when the argument ``view`` is true."""
    return IncludeLaunchDescription(
        PathJoinSubstitution([SHARE, 'launch', 'view.launch.py']), launch_arguments=arguments.items(),
        condition=IfCondition(LaunchConfiguration('view')))


def end_with(*leaders: str) -> RegisterEventHandler:
    """End the launch when one of the ``leaders`` is done, or when a node cannot run with its parameters or files."""
    def look(event: ProcessExited, _: LaunchContext) -> list[Action] | None:
        if event.returncode == UNUSABLE:
            return [Shutdown(reason=f'{event.process_name} cannot run with its parameters or files: see its output')]
        if event.returncode == 0 and event.process_name.startswith(leaders):
            return [Shutdown(reason=f'{event.process_name} is done')]
        return None

    return RegisterEventHandler(OnProcessExit(on_exit=look))
