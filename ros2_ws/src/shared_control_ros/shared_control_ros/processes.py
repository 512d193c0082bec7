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

"""Processes of nodes: the module that each is, and their environment."""

import os
import sys
import sysconfig
from importlib.machinery import PathFinder
from importlib.metadata import entry_points
from pathlib import Path

DDS_PROFILE = Path(__file__).parent / 'config' / 'this_machine.xml'
_DDS_DECISIONS = ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE')
_DDS_VARIABLES = ('ROS_DISCOVERY_SERVER', 'ROS_SUPER_CLIENT', 'ROS_STATIC_PEERS', 'ROS_LOCALHOST_ONLY',
                  'FASTDDS_BUILTIN_TRANSPORTS', 'FASTDDS_DEFAULT_PROFILES_FILE', 'RMW_FASTRTPS_USE_QOS_FROM_XML')
"""What also says how nodes find each other, and would keep them from it on this machine."""
_ANOTHER_INSTALL = {
    'PYTHONPATH': ('rclpy', 'shared_control'),
    'LD_LIBRARY_PATH': ('librcl.so*', 'librmw*.so*', 'librcutils.so*', 'libfastrtps.so*', 'libfastdds.so*')}
"""Patterns by which a folder in a variable tells of another install of ROS, or another copy of this project."""
_LIBRARIES_FOUND = '_ROS_WHEELS_BOOTSTRAP_COMPLETE'
"""By this, a new Python with ROS from wheels knows that LD_LIBRARY_PATH leads to their libraries already."""


def node_module(name: str) -> str:
    """The module of the node (executable) called ``name``, for ``python -m``.

    Raises:
        ValueError: no installed package has it.
    """
    for script in entry_points(group='console_scripts', name=name):
        return script.module.removesuffix('.__main__')
    raise ValueError(f'no node {name!r} is installed')


def node_environment() -> dict[str, str]:
    """The environment for nodes: one thread each, DDS on this machine only, and no other ROS than this one.

    Whoever sets ``ROS_AUTOMATIC_DISCOVERY_RANGE`` or ``FASTRTPS_DEFAULT_PROFILES_FILE`` decides about DDS instead:
    ``ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET`` opens the graph to the network. Where ``rclpy`` is installed beside this
    package, what the shell says of another install is left out; where it is not, the shell is what leads to it.
    """
    environment = {'OMP_NUM_THREADS': '1', 'PYTHONUNBUFFERED': '1', **os.environ}
    environment['PYTHONSAFEPATH'] = '1'  # no module is taken from the folder that somebody happens to be in
    if not any(variable in os.environ for variable in _DDS_DECISIONS):
        environment['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'SYSTEM_DEFAULT'  # as the profile says
        environment['FASTRTPS_DEFAULT_PROFILES_FILE'] = str(DDS_PROFILE)
        for variable in _DDS_VARIABLES:
            environment.pop(variable, None)
    if _has_its_own_ros():
        environment.pop('RMW_IMPLEMENTATION', None)
        for variable, signs in _ANOTHER_INSTALL.items():
            if variable in environment:
                environment[variable] = _without(environment[variable], signs)
        if sys.prefix not in environment.get('LD_LIBRARY_PATH', ''):  # replaced since this process began
            environment.pop(_LIBRARIES_FOUND, None)
    return environment


def adopt_node_environment() -> None:
    """Give this process the environment for nodes."""
    environment = node_environment()
    for variable in os.environ.keys() - environment.keys():
        del os.environ[variable]
    os.environ.update(environment)


def _has_its_own_ros() -> bool:
    """Whether ``rclpy`` is installed in this environment, and not reached by the variables of a shell."""
    return PathFinder.find_spec('rclpy', [sysconfig.get_path('purelib'), sysconfig.get_path('platlib')]) is not None


def _without(paths: str, signs: tuple[str, ...]) -> str:
    """``paths``, as in ``PATH``, without the folders outside this environment that hold a file named like a sign."""
    return os.pathsep.join(
        path for path in paths.split(os.pathsep) if Path(path).is_relative_to(sys.prefix)
        or (path and not any(any(Path(path).glob(sign)) for sign in signs)))
