"""Processes of nodes: their environment, and that they do not outlive the one that started them."""

import os
from importlib.metadata import entry_points
from pathlib import Path

from shared_control.processes import leave_with_the_parent

__all__ = ['leave_with_the_parent', 'node_environment', 'node_module']

DDS_PROFILE = Path(__file__).parent / 'config' / 'this_machine.xml'
_DDS_VARIABLES = ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE')


def node_module(name: str) -> str:
    """The module of the node (executable) called ``name``, for ``python -m``.

    Raises:
        ValueError: no installed package has it.
    """
    for script in entry_points(group='console_scripts', name=name):
        return script.module
    raise ValueError(f'no node {name!r} is installed')


def node_environment() -> dict[str, str]:
    """The environment for nodes: one thread each, and DDS on this machine only.

    Whoever sets ``ROS_AUTOMATIC_DISCOVERY_RANGE`` or ``FASTRTPS_DEFAULT_PROFILES_FILE`` decides about DDS instead:
    ``ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET`` opens the graph to the network.
    """
    environment = {'OMP_NUM_THREADS': '1', 'PYTHONUNBUFFERED': '1', **os.environ}
    if not any(variable in os.environ for variable in _DDS_VARIABLES):
        environment['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'SYSTEM_DEFAULT'  # as the profile says
        environment['FASTRTPS_DEFAULT_PROFILES_FILE'] = str(DDS_PROFILE)
    return environment
