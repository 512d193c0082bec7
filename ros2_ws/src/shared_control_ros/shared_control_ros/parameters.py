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

"""Parameters with a description, a unit and a range."""

import re
from collections.abc import Callable, Iterator, Sequence
from difflib import SequenceMatcher, get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import Any

import yaml
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException, ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control.printable import shortened

SECTION = 'ros__parameters'
"""What a parameter file has below the name of a node."""
ALIKE = 0.85
"""Names that are more alike than this are one with a slip in it; no two nodes of this project are, by `difflib`."""


class ParameterError(ValueError):
    """A parameter has a value that the node cannot run with; the message names both."""


def declare(node: Node, name: str, default: Any, description: str, *, unit: str = '',
            minimum: float | None = None, maximum: float | None = None,
            choices: tuple[str, ...] = (), read_only: bool = True) -> Any:
    """Declare one parameter and give its value.

    A range is enforced by rclpy when both ends are given. ``choices`` lists the valid strings.

    Raises:
        ParameterError: the given value has the wrong type, is out of range or is no valid choice.
    """
    text = description + (f' [{unit}]' if unit else '') + (f' One of: {", ".join(choices)}.' if choices else '')
    descriptor = ParameterDescriptor(description=text, read_only=read_only)
    if minimum is not None and maximum is not None:
        if isinstance(default, float):
            descriptor.floating_point_range = [FloatingPointRange(from_value=minimum, to_value=maximum)]
        else:
            descriptor.integer_range = [IntegerRange(from_value=int(minimum), to_value=int(maximum))]
    # YAML reads a bare off as a boolean: take it, and every other type, and compare with the choices below.
    descriptor.dynamic_typing = bool(choices) and isinstance(default, str)
    try:
        value = node.declare_parameter(name, default, descriptor).value
    except InvalidParameterTypeException as error:
        raise ParameterError(
            f'parameter {name!r} must be of type {type(default).__name__}: {error}. {text}') from error
    except (InvalidParameterValueException, ParameterException) as error:
        span = f'{minimum} to {maximum}' if minimum is not None else 'see description'
        raise ParameterError(f'parameter {name!r} is out of range ({span}): {error}. {text}') from error
    if choices:
        if isinstance(value, bool):
            value = 'on' if value else 'off'
        wrong = [v for v in (value if isinstance(value, list) else [value]) if v not in choices]
        if wrong:
            raise ParameterError(f'parameter {name!r} has no choice {wrong[0]!r}. {text}')
    return value


def refuse_unknown_types(node: Node) -> None:
    """Refuse a request to set parameters one of which is of no type that there is.

    rclpy raises an error at it, which would end the node.
    """
    for service in node.services:
        if service.srv_type in (SetParameters, SetParametersAtomically):
            service.callback = _of_known_types(service.callback)


def _of_known_types(serve: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def serve_or_refuse(request: Any, response: Any) -> Any:
        for parameter in request.parameters:
            try:
                Parameter.from_parameter_msg(parameter)
            except ValueError as error:
                refusal = SetParametersResult(
                    successful=False, reason=f'nothing is set: parameter {shortened(parameter.name)}: {error}')
                if isinstance(response, SetParameters.Response):
                    response.results = [refusal for _ in request.parameters]
                else:
                    response.result = refusal
                return response
        return serve(request, response)
    return serve_or_refuse


def unknown_parameters(node: Node) -> list[str]:
    """What was given to a node that has declared all of its parameters, and is none of them: a line each.

    ROS passes over them in silence, so that a limit with a slip in its name is not the limit.
    """
    given = node._parameter_overrides  # rclpy has no public way to them
    known = list(node.get_parameters_by_prefix(''))
    lines = []
    for name in sorted(given.keys() - set(known)):
        meant = get_close_matches(name, known, n=1)
        lines.append(f'there is no parameter {shortened(name)}, and it counts nothing'
                     + (f': is {meant[0]!r} meant?' if meant else '; `ros2 param list` shows what there is'))
    return lines


def passed_over_files(node: Node, arguments: Sequence[str]) -> list[str]:
    """The parameter files among a node's arguments that are meant for it, as it seems, and are not for it: a line each.

    ROS passes over a section of another namespace, or of a name with a slip in it, in silence. A file for other nodes
    may be given to this one, too, as launch files do.
    """
    own = node.get_fully_qualified_name()
    lines = []
    for path in (Path(value) for flag, value in pairwise(arguments) if flag == '--params-file'):
        if not path.is_file():  # a pipe is read once
            continue
        sections = list(_sections(yaml.safe_load(path.read_bytes()), ''))
        meant = next((section for section in sections if _is_alike(section, own)), None)
        if meant and not any(_matches(section, own) for section in sections):
            lines.append(f'{path} has no section for {own}, and nothing in it counts here: is {meant} meant? '
                         f'/**/{node.get_name()}: counts in every namespace (sections: {", ".join(sections)})')
    return lines


def _sections(content: Any, namespace: str) -> Iterator[str]:
    """The nodes that a parameter file names, each with its namespace."""
    for key, value in content.items() if isinstance(content, dict) else ():
        if key != SECTION and isinstance(value, dict):
            name = f'{namespace}/{str(key).strip("/")}'
            if SECTION in value:
                yield name
            yield from _sections(value, name)


def _matches(section: str, node: str) -> bool:
    """Whether a section is for a node, by the rules of rcl: * is any name, ** any number of them."""
    pattern = section.replace('/**', r'(/\w+)*').replace('/*', r'(/\w+)')
    return re.fullmatch(pattern, node) is not None


def _is_alike(section: str, node: str) -> bool:
    """Whether the last names are one, but for a slip."""
    last, own = (name.rpartition('/')[2].removesuffix('_node') for name in (section, node))
    return SequenceMatcher(None, last, own).ratio() > ALIKE
