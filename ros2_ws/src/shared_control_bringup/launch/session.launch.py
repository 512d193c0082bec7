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

"""A session: simulator, controller, keys, agent, recorder. It ends when the agent is done.

With ``tutor:=keyboard`` the teaching screen takes the terminal of the launch, and what the nodes say goes to launch's
log folder. ``shared-control session`` starts the same nodes without launch, tests the policy and writes a report as
well.
"""

import time
from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from shared_control.plugins import LEARNERS, TASKS, WORLDS, names
from shared_control.teaching.tutors import TUTOR_NAMES
from shared_control_bringup import parameters
from shared_control_bringup.graph import Role, named, nodes_of, overrides
from shared_control_bringup.launching import (
    common_arguments,
    end_with,
    environment,
    graph_node,
    in_namespace,
    view,
    view_argument,
)
from shared_control_bringup.parameter_check import check_values, refuse_overridden
from shared_control_bringup.settings import TUTORS, Settings
from shared_control_ros.host_and_port import host_and_port


def start_nodes(context: LaunchContext) -> list[Node]:
    """The nodes of the session that the arguments describe.

    Raises:
        ValueError: an argument or the parameter file cannot be used.
        RuntimeError: the Python of ``ros2`` lacks what the nodes have.
    """
    try:
        return _nodes(context)
    except ModuleNotFoundError as error:
        raise RuntimeError(
            f'{error}: a session reckons with its task, by packages of pip that the Python of this ros2 has not. '
            'Use that of the nodes: VENV/bin/python $(which ros2) launch shared_control_bringup session.launch.py'
        ) from error


def _nodes(context: LaunchContext) -> list[Node]:
    settings = Settings(
        tutor=LaunchConfiguration('tutor').perform(context),
        profile=LaunchConfiguration('profile').perform(context),
        task=LaunchConfiguration('task').perform(context),
        preset=LaunchConfiguration('preset').perform(context),
        physics=LaunchConfiguration('physics').perform(context),
        episodes=int(LaunchConfiguration('episodes').perform(context)),
        minutes=float(LaunchConfiguration('minutes').perform(context)),
        seed=int(LaunchConfiguration('seed').perform(context)),
        page=host_and_port(LaunchConfiguration('page').perform(context))).resolved()
    by_hand = settings.tutor == 'keyboard'
    given = overrides(settings, Path(LaunchConfiguration('output').perform(context)), shows_screen=by_hand)
    params_file = Path(LaunchConfiguration('params_file').perform(context))
    values = parameters.read(params_file.read_bytes(), params_file)
    check_values(values, params_file)
    refuse_overridden(values, given, params_file)
    return [graph_node(node.name, parameters=given[node.name], output='own_log' if by_hand else 'screen')
            for node in nodes_of(settings.tutor)]


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        DeclareLaunchArgument('tutor', default_value='keyboard', choices=list(TUTORS),
                              description='Who teaches: you, here or in a browser, a simulated tutor, or nobody.'),
        DeclareLaunchArgument('profile', default_value='expert', choices=list(TUTOR_NAMES),
                              description='Of the simulated tutor.'),
        DeclareLaunchArgument('task', default_value='balance', choices=names(TASKS), description='What is learned.'),
        DeclareLaunchArgument('preset', default_value='', choices=['', *names(LEARNERS)],
                              description='How it is learned; empty: as the task is.'),
        DeclareLaunchArgument('physics', default_value='bullet', choices=names(WORLDS),
                              description='What the arm moves in.'),
        DeclareLaunchArgument('episodes', default_value='0',
                              description='Teach this many, then test; 0: until somebody says that it has learned it.'),
        DeclareLaunchArgument('minutes', default_value='45.0', description='Teach for this long at the most.'),
        DeclareLaunchArgument('seed', default_value='0', description='Of ball starts, learner and simulated tutor.'),
        DeclareLaunchArgument('page', default_value='127.0.0.1:8088',
                              description='HOST:PORT of the page; another host than loopback opens it, with a token.'),
        DeclareLaunchArgument('output', default_value=time.strftime('out/sessions/%Y-%m-%d_%H-%M-%S'),
                              description='Folder for bag/ and learner/.'),
        *common_arguments(),
        view_argument(),
        *environment(),
        in_namespace([OpaqueFunction(function=start_nodes)]),
        view(),
        end_with(*named(Role.LEADER, Role.STOPPER)),
    ])
