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

"""What ``import shared_control`` offers."""

import ast
import subprocess
import sys
from pathlib import Path
from types import FunctionType

import pytest
import shared_control

WITHOUT = """
import sys
sys.modules[{module!r}] = None  # as if it were not installed
import shared_control
try:
    shared_control.{name}
except ImportError as error:
    print(error)
"""


def said_by(code):
    return subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True).stdout


def test_type_checkers_and_python_see_the_same_names():
    tree = ast.parse(Path(shared_control.__file__).read_text())
    block = next(node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == 'TYPE_CHECKING')
    seen = {alias.name: '.' * node.level + node.module for node in block.body for alias in node.names}
    assert sorted(seen) == sorted(shared_control.__all__) == sorted(shared_control._MODULE_OF)
    for name, module in seen.items():
        assert shared_control._MODULE_OF[name] == (f'shared_control{module}' if module.startswith('.') else module)
    assert set(shared_control.__all__) <= set(dir(shared_control))


def test_names_are_what_they_say():
    for name in shared_control.__all__:
        value = getattr(shared_control, name)
        if isinstance(value, type | FunctionType):
            assert value.__name__ == name
    with pytest.raises(AttributeError, match='no attribute'):
        shared_control.nothing  # noqa: B018


def test_nothing_is_loaded_before_it_is_asked_for():
    loaded = set(said_by('import shared_control, sys; print(*sys.modules)').split())
    assert not loaded & {'numpy', 'pinocchio', 'gymnasium', 'pybullet', 'torch', 'importlib.metadata'}


@pytest.mark.parametrize(('module', 'name', 'extra'), [
    ('gymnasium', 'SharedControlEnv', 'sim'), ('pybullet', 'BulletWorld', 'sim'), ('torch', 'train', 'learn'),
    ('pybullet', "load('shared_control.worlds', 'bullet')", 'sim'),
    ('mujoco', "load('shared_control.worlds', 'mujoco')", 'mujoco'),
    ('shared_control_learning', 'preset', 'learn')])
def test_what_is_missing_says_how_to_install_it(module, name, extra):
    said = said_by(WITHOUT.format(module=module, name=name))
    assert f'needs the module {module!r}, which is not installed: pip install "shared-control[{extra}]"' in said
