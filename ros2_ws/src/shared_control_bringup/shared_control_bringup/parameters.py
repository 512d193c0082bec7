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

"""The parameters of a session: the file that comes with the package, a file that is laid over it, and overrides."""

import re
from pathlib import Path
from typing import Any

import yaml
from shared_control.files import write_atomically
from shared_control.strict_yaml import StrictLoader

from .graph import ALL_NODES

DEFAULTS = Path(__file__).parent / 'config' / 'session.yaml'
ANY_NODE = '/**'
"""Where a parameter file has values for all nodes."""

_PROPERTIES = re.compile(r'(?:[&!]\S*\s+)*')
"""Anchor and tag before a value in YAML."""


class _WithoutAliases(yaml.SafeDumper):
    """Writes out what occurs twice, since ROS refuses aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        """See :class:`yaml.SafeDumper`."""
        return True


def load(path: Path = DEFAULTS) -> dict[str, dict[str, Any]]:
    """Parameters by node: the defaults, with the values of a file laid over them.

    A node named for any namespace (``/**/NODE``) appears under its name.

    Raises:
        ValueError: the file is not a ROS parameter file, or names a node that does not exist; the message names it.
        OSError: it cannot be read.
    """
    return over_defaults(read(path.read_bytes(), path))


def over_defaults(given: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """The defaults with values laid over them, as :func:`read` gives these."""
    parameters = read(DEFAULTS.read_bytes(), DEFAULTS)
    if everywhere := given.get(ANY_NODE):
        parameters = lay_over(parameters, dict.fromkeys(ALL_NODES, everywhere))
    return lay_over(parameters, {node: values for node, values in given.items() if node != ANY_NODE})


def lay_over(parameters: dict[str, dict[str, Any]], values: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """A copy of ``parameters`` with ``values`` in it, both by node."""
    return {node: {**parameters.get(node, {}), **values.get(node, {})} for node in (*parameters, *values)}


def save(parameters: dict[str, dict[str, Any]], path: Path) -> None:
    """Write a ROS parameter file."""
    content = {node: {'ros__parameters': values} for node, values in parameters.items()}
    write_atomically(path, yaml.dump(content, Dumper=_WithoutAliases, sort_keys=False).encode())


def blanked(text: bytes, name: str) -> bytes:
    """A parameter file in which every parameter ``name`` is an empty text, and all else as it was, comments and layout.

    ``text``: of a file that :func:`read` takes.
    """
    content = text.decode('utf-8')
    found: set[tuple[int, int]] = set()
    seen: set[int] = set()  # an alias is the node that it stands for, and may be within it
    ahead: list[yaml.Node] = [yaml.compose(content, yaml.SafeLoader)]
    while ahead:
        node = ahead.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            ahead += node.value
        elif isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                if key.value == name:
                    found.add((value.start_mark.index, value.end_mark.index))
                else:
                    ahead.append(value)
    for start, end in sorted(found, reverse=True):
        value = content[start:end]
        properties = _PROPERTIES.match(value)[0]  # type: ignore[index]
        line_end = '\n' if value.endswith('\n') else ''  # of a block of lines
        content = f"{content[:start]}{properties}''{line_end}{content[end:]}"
    return content.encode('utf-8')


def read(text: bytes, path: Path) -> dict[str, dict[str, Any]]:
    """The parameters that a file has in it, by node, and those for all nodes under :data:`ANY_NODE`.

    Args:
        text: of the file.
        path: that messages name.

    Raises:
        ValueError: see :func:`load`.
    """
    try:
        content = yaml.load(text.decode('utf-8'), StrictLoader)
    except RecursionError as error:
        raise ValueError(f'{path} is not a ROS parameter file: it is nested too deeply') from error
    except (yaml.YAMLError, ValueError) as error:  # of a date that there is none of, the latter
        raise ValueError(f'{path} is not valid YAML: {error}') from error
    if not isinstance(content, dict):
        raise ValueError(f'{path} is not a ROS parameter file: expected NODE: ros__parameters: NAME: VALUE')
    parameters = {}
    for key, section in content.items():
        node = str(key).removeprefix(ANY_NODE + '/').removeprefix('/') if key != ANY_NODE else ANY_NODE
        if node not in (*ALL_NODES, ANY_NODE):
            raise ValueError(f'{path}: there is no node {key!r}; there are {", ".join(ALL_NODES)}')
        if not isinstance(section, dict) or not isinstance(section.get('ros__parameters'), dict):
            raise ValueError(f'{path}: node {key!r} has no ros__parameters')
        parameters[node] = dict(section['ros__parameters'])
    return parameters
