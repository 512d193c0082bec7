"""What the sources say about a node's parameters, without starting the node."""

import ast
import re
from dataclasses import dataclass
from pathlib import Path

from shared_control_ros.processes import node_module

PACKAGES = Path(__file__).parents[2]
SHARED = PACKAGES / 'shared_control_ros' / 'shared_control_ros'


@dataclass(frozen=True)
class Declaration:
    """A call of :func:`shared_control_ros.parameters.declare`."""

    name: str
    value: object
    """The default; None where it is no literal."""
    default: str
    """The default as it is written."""
    description: str
    """As the sources write it, with unit and range; empty where it is no literal."""


def declarations(node: str) -> list[Declaration]:
    """Parameters that a node declares, itself or by a shared declaration, by name.

    A shared declaration is a module ``*_parameter.py`` of ``shared_control_ros`` that the node imports.

    Args:
        node: the node's executable.
    """
    package, *rest = node_module(node).split('.')
    folder = (PACKAGES / package / package).joinpath(*rest)
    texts = [path.read_text() for path in folder.glob('*.py')]
    shared = {name for text in texts for name in re.findall(r'shared_control_ros\.(\w+_parameter) import', text)}
    texts += [(SHARED / f'{name}.py').read_text() for name in shared]
    found = {}
    for call in [item for text in texts for item in ast.walk(ast.parse(text))]:
        if isinstance(call, ast.Call) and ast.unparse(call.func) == 'declare':
            name = call.args[1]
            if isinstance(name, ast.Constant):
                found[str(name.value)] = _declaration(call)
    return [found[name] for name in sorted(found)]


def _declaration(call: ast.Call) -> Declaration:
    name, default, text = call.args[1:4]
    extras = {keyword.arg: ast.unparse(keyword.value).strip("'") for keyword in call.keywords}
    description = str(text.value) if isinstance(text, ast.Constant) else ''
    description += f' [{extras["unit"]}]' if 'unit' in extras else ''
    description += f' ({extras["minimum"]} to {extras["maximum"]})' if {'minimum', 'maximum'} <= extras.keys() else ''
    assert isinstance(name, ast.Constant)
    return Declaration(str(name.value), default.value if isinstance(default, ast.Constant) else None,
                       ast.unparse(default), description)


def declared_parameters(node: str) -> dict[str, object]:
    """Default by name of :func:`declarations`; None where the default is no literal."""
    return {found.name: found.value for found in declarations(node)}
