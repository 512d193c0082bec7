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

"""What the sources say about a node's parameters, without starting the node."""

import ast
import re
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .processes import node_module

SHARED = Path(__file__).parent
TASK = 'balance'
"""The default of the shared declaration of ``task``."""


@dataclass(frozen=True)
class Declaration:
    """A call of :func:`shared_control_ros.parameters.declare`."""

    name: str
    """``...`` stands in it for what the sources compute."""
    value: object
    """The default; None where it is no literal."""
    default: str
    """The default as it is written."""
    shown: str
    """The default for people to read: what a constant stands for, and true and false as in YAML."""
    description: str
    """As the sources write it, with unit and range; with ... for what they compute."""
    is_choice: bool = False
    """Whether it has a fixed set of values, all of them texts."""
    choices: tuple[str, ...] = ()
    """These values; empty where they are no literals."""
    minimum: float | None = None
    """None: there is none, or it is no literal."""
    maximum: float | None = None
    """Likewise."""

    @property
    def type(self) -> type | None:
        """What a value must be; None: not known."""
        known = self.value if self.value is not None else self.minimum
        return None if known is None else type(known)


def declarations(node: str) -> list[Declaration]:
    """Parameters that a node declares, itself or by a shared declaration, by name.

    A shared declaration is a module ``*_parameter.py`` of ``shared_control_ros`` that the node imports.

    Args:
        node: the node's executable.
    """
    return declarations_of(node_module(node))


def declarations_of(package: str) -> list[Declaration]:
    """As :func:`declarations`, for the package of a node."""
    spec = find_spec(package)
    assert spec is not None and spec.origin is not None, package
    texts = [path.read_text(encoding='utf-8') for path in Path(spec.origin).parent.glob('*.py')]
    shared = {name for text in texts for name in re.findall(r'shared_control_ros\.(\w+_parameter) import', text)}
    texts += [(SHARED / f'{name}.py').read_text(encoding='utf-8') for name in shared]
    found = {}
    sources = [ast.parse(text) for text in texts]
    for call, module in [(item, source) for source in sources for item in ast.walk(source)]:
        if not isinstance(call, ast.Call):
            continue
        if ast.unparse(call.func) == 'declare_task':
            found['task'] = Declaration('task', TASK, repr(TASK), TASK, _text(call.args[1]), is_choice=True)
        elif ast.unparse(call.func) == 'declare' and (name := _text(call.args[1])) and name not in found:
            found[name] = _declaration(call, module)
    return [found[name] for name in sorted(found)]


def _declaration(call: ast.Call, module: ast.Module) -> Declaration:
    name, default, text = call.args[1:4]
    extras = {keyword.arg: ast.unparse(keyword.value).strip("'") for keyword in call.keywords}
    description = _text(text)
    description += f' [{extras["unit"]}]' if 'unit' in extras else ''
    description += f' ({extras["minimum"]} to {extras["maximum"]})' if {'minimum', 'maximum'} <= extras.keys() else ''
    given = {str(keyword.arg): _literal(keyword.value) for keyword in call.keywords}
    return Declaration(
        _text(name), _literal(default), ast.unparse(default), _shown(default, module), description,
        is_choice='choices' in given, choices=given.get('choices') or (), minimum=given.get('minimum'),
        maximum=given.get('maximum'))


def _literal(written: ast.expr) -> Any:
    """The value of an expression; None where it is no literal."""
    try:
        return ast.literal_eval(written)
    except ValueError:
        return None


def _shown(default: ast.expr, module: ast.Module) -> str:
    written = ast.unparse(default)
    if 'task.' in written:
        return 'as the task has it'
    try:
        value = ast.literal_eval(default)
    except ValueError:
        return _constant(written, module)
    if isinstance(value, list):
        return ', '.join(map(str, value))
    return str(value).lower() if isinstance(value, bool) else str(value) or 'empty'


def _constant(name: str, module: ast.Module) -> str:
    """What the constant ``name``, as in ``Ball.mass``, stands for in ``module``; its name where that is computed."""
    first, _, rest = name.partition('.')
    for statement in module.body:
        if isinstance(statement, ast.ImportFrom) and statement.level == 0 and first in {
                alias.name for alias in statement.names}:
            spec = find_spec(str(statement.module))
            return _constant(name, ast.parse(Path(str(spec.origin)).read_text(encoding='utf-8'))) if spec else name
        if isinstance(statement, ast.ClassDef) and statement.name == first and rest:
            return _constant(rest, ast.Module(statement.body, []))
        target = statement.target if isinstance(statement, ast.AnnAssign) else (
            statement.targets[0] if isinstance(statement, ast.Assign) else None)
        value = getattr(statement, 'value', None)
        if isinstance(target, ast.Name) and target.id == first and value is not None:
            return _shown(value, module)
    return name


def _text(written: ast.expr) -> str:
    """A text as it is written in a program."""
    if isinstance(written, ast.Constant):
        return str(written.value)
    parts = written.values if isinstance(written, ast.JoinedStr) else []
    return ''.join(str(part.value) if isinstance(part, ast.Constant) else '...' for part in parts)


def declared_parameters(node: str) -> dict[str, object]:
    """Default by name of :func:`declarations`; None where the default is no literal."""
    return {found.name: found.value for found in declarations(node)}
