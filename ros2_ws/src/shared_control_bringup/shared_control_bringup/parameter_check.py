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

"""Whether nodes can run with the values in a parameter file: looked at before anything is started or removed."""

import re
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from shared_control.robot.spec_file import is_path, load_robot
from shared_control_ros.declarations import Declaration, declarations

from .graph import ALL_NODES
from .parameters import ANY_NODE, over_defaults

OF_ROS = ('use_sim_time', 'start_type_description_service', 'qos_overrides', 'qos_overrides.*')
"""Parameters that every node has of rclpy, as patterns."""
_EXPONENT = re.compile(r'[-+]?\d+[eE][-+]?\d+')
"""A number to ROS, and a text to YAML 1.1."""


def check_values(given: dict[str, dict[str, Any]], path: Path) -> None:
    """Compare the values in a file with what the nodes declare.

    Args:
        given: see :func:`.parameters.read`.
        path: that messages name.

    Raises:
        ValueError: a node has no such parameter, or could not run with its value; the message names all three.
    """
    for node, values in given.items():
        nodes = ALL_NODES if node == ANY_NODE else (node,)
        declared = [declaration for name in nodes for declaration in declarations(name)] if values else []
        for name, value in values.items():
            if any(fnmatchcase(str(name), pattern) for pattern in OF_ROS):
                continue
            meant = [declaration for declaration in declared
                     if fnmatchcase(str(name), declaration.name.replace('...', '*'))]
            if not meant:
                there_are = ', '.join(sorted({declaration.name for declaration in declared}))
                raise ValueError(f'{path}: {node} has no parameter {name!r}; there are {there_are}')
            for declaration in meant:
                if problem := _problem(declaration, value) or (_robot_problem(value) if name == 'robot' else ''):
                    raise ValueError(f'{path}: parameter {name!r} of {node} {problem}')


def refuse_overridden(given: dict[str, dict[str, Any]], taken: dict[str, dict[str, Any]], path: Path) -> None:
    """Refuse values in a file that a session would not go by. Those of the defaults may stand in it: it may be a copy.

    Args:
        given: see :func:`.parameters.read`.
        taken: see :func:`.graph.overrides`.
        path: that messages name.

    Raises:
        ValueError: the session has another value for a parameter; the message names all.
    """
    defaults = over_defaults({})
    for node, values in taken.items():
        wanted = {**given.get(ANY_NODE, {}), **given.get(node, {})}
        for name in values.keys() & wanted.keys():
            if wanted[name] not in (values[name], defaults.get(node, {}).get(name)):
                raise ValueError(
                    f'{path}: parameter {name!r} of {node} is {wanted[name]!r}, but a session gives it '
                    f'{values[name]!r}, by its task and its options: use these, and leave it out')


def _problem(declaration: Declaration, value: Any) -> str:
    """What is wrong with a value; empty: nothing that the declaration tells."""
    wanted = declaration.type
    if value is None:
        return 'has no value'
    if wanted is float and isinstance(value, str) and _EXPONENT.fullmatch(value):
        value = float(value)
    takes_any_type = declaration.is_choice and wanted is not list  # a bare off is a boolean in YAML
    if wanted is not None and type(value) is not wanted and not takes_any_type:
        point = f': write {value}.0' if wanted is float and type(value) is int else ''
        return f'must be of type {wanted.__name__}, not {value!r}{point}'
    if isinstance(value, list) and isinstance(declaration.value, list):
        kind = type(declaration.value[0])
        for item in value:
            if type(item) is not kind:
                return f'must be a list of {kind.__name__}, and {item!r} is none'
    for item in (value if isinstance(value, list) else [value]) if declaration.choices else []:
        word = ('on' if item else 'off') if isinstance(item, bool) else item
        if word not in declaration.choices:
            return f'has no choice {word!r}; there are {", ".join(declaration.choices)}'
    if declaration.minimum is not None and declaration.maximum is not None and not (
            declaration.minimum <= value <= declaration.maximum):
        return f'must be at least {declaration.minimum} and at most {declaration.maximum}, not {value}'
    return ''


def _robot_problem(name: str) -> str:
    """What is wrong with a robot; its file is found from wherever the session goes on."""
    if is_path(name) and not Path(name).expanduser().is_absolute():
        return f'must be the whole path of its file: write {Path(name).absolute()}'
    try:
        load_robot(name)
    except ValueError as error:
        return f'cannot be used: {error}'
    return ''
