"""What the sources say about a node's parameters, without starting the node."""

import ast
import re
from pathlib import Path

from shared_control_ros.processes import node_module

PACKAGES = Path(__file__).parents[2]
SHARED = PACKAGES / 'shared_control_ros' / 'shared_control_ros'


def declared_parameters(node: str) -> dict[str, object]:
    """Parameters that a node declares, itself or by a shared declaration, and their defaults.

    A shared declaration is a module ``*_parameter.py`` of ``shared_control_ros`` that the node imports.

    Args:
        node: the node's executable.

    Returns:
        Default by name; None where the default is no literal.
    """
    package, *rest = node_module(node).split('.')
    folder = (PACKAGES / package / package).joinpath(*rest)
    texts = [path.read_text() for path in folder.glob('*.py')]
    shared = {name for text in texts for name in re.findall(r'shared_control_ros\.(\w+_parameter) import', text)}
    texts += [(SHARED / f'{name}.py').read_text() for name in shared]
    found: dict[str, object] = {}
    for call in [item for text in texts for item in ast.walk(ast.parse(text))]:
        if isinstance(call, ast.Call) and ast.unparse(call.func) == 'declare':
            name, default = call.args[1:3]
            if isinstance(name, ast.Constant):
                found[str(name.value)] = default.value if isinstance(default, ast.Constant) else None
    return found
