"""Every package of the workspace: complete for colcon, rosdep, ``ros2 run`` and pip."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from catkin_pkg.package import parse_package

ROOT = Path(__file__).parents[1]
PACKAGES = sorted(path.parent for path in (ROOT / 'ros2_ws' / 'src').glob('*/package.xml'))
NAMES = {package.name for package in PACKAGES}
ROSDEP = {
    'numpy': 'python3-numpy', 'yaml': 'python3-yaml', 'matplotlib': 'python3-matplotlib', 'jinja2': 'python3-jinja2',
    'markupsafe': 'python3-jinja2', 'scipy': 'python3-scipy', 'pandas': 'python3-pandas', 'tqdm': 'python3-tqdm'}
"""Keys of modules that a Jazzy machine gets from Debian packages."""
PIP = {'pinocchio': 'pin', 'mujoco': 'mujoco-core',
       'markupsafe': 'jinja2', 'fastapi': 'nicegui', 'starlette': 'nicegui', 'uvicorn': 'nicegui'}
"""Where modules come from that are in no distribution of their name."""
ROS = {'rclpy', 'launch', 'launch_ros'}
OPTIONAL = {'pytest', 'selenium', 'panda_py', 'ray', 'rerun', 'lerobot'}
"""Imported where they are needed, with a clear message when they are missing."""


def tree(package):
    return ElementTree.parse(package / 'package.xml').getroot()


def setup_arguments(package):
    """Keyword arguments of ``setup()``, as far as they are literals."""
    call = next(node for node in ast.walk(ast.parse((package / 'setup.py').read_text()))
                if isinstance(node, ast.Call) and ast.unparse(node.func) == 'setup')
    found = {}
    for keyword in call.keywords:
        try:
            found[keyword.arg] = ast.literal_eval(keyword.value)
        except ValueError:
            pass
    return found


class WithoutTypeChecking(ast.NodeTransformer):
    """Leaves out what only a type checker imports."""

    def visit_If(self, node):
        return node.orelse if ast.unparse(node.test) == 'TYPE_CHECKING' else self.generic_visit(node)


def imported(package):
    """Top-level modules that a package imports, the standard library's and its own left out."""
    names = set()
    for path in [*(package / package.name).rglob('*.py'), *(package / 'launch').glob('*.py')]:
        for node in ast.walk(WithoutTypeChecking().visit(ast.parse(path.read_text()))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.split('.')[0])
    return names - sys.stdlib_module_names - OPTIONAL - {package.name}


def is_ros(module):
    return module in ROS or module.endswith(('_msgs', '_interfaces', '_srvs'))


@pytest.fixture(params=PACKAGES, ids=lambda path: path.name)
def package(request):
    return request.param


def test_package_xml_and_setup_py_say_the_same(package):
    root, setup = tree(package), setup_arguments(package)
    assert root.get('format') == '3'
    assert root.findtext('name') == package.name
    assert root.findtext('export/build_type') == 'ament_python'
    assert root.findtext('version') == setup['version']
    assert root.findtext('license') == setup['license'] == 'Apache-2.0'
    assert root.findtext('maintainer') == setup['maintainer']
    assert root.findtext('test_depend') == 'python3-pytest'
    assert 'pytest' in setup['extras_require']['test'] and 'tests_require' not in setup  # which breaks colcon test


def test_one_version_everywhere():
    version = tomllib.loads((ROOT / 'pyproject.toml').read_text())['project']['version']
    assert {setup_arguments(package)['version'] for package in PACKAGES} == {version}
    assert yaml.safe_load((ROOT / 'CITATION.cff').read_text())['version'] == version
    assert f'\n## {version} (' in (ROOT / 'CHANGELOG.md').read_text()


def test_ros2_run_finds_the_package_and_its_executable(package):
    assert (package / 'resource' / package.name).is_file()
    assert (package / 'README.md').is_file()
    config = (package / 'setup.cfg').read_text()
    assert config.count(f'=$base/lib/{package.name}\n') == 2
    if package.name.endswith('_node'):
        scripts = setup_arguments(package)['entry_points']['console_scripts']
        assert f'{package.name} = {package.name}.__main__:main' in scripts


def test_all_that_is_imported_is_depended_upon(package):
    depends = {depend.text for depend in tree(package).iter('exec_depend')}
    notes = (package / 'package.xml').read_text()
    for module in sorted(imported(package)):
        if module in NAMES or is_ros(module):
            assert module in depends
        elif module in ROSDEP:
            assert ROSDEP[module] in depends
        else:
            assert re.search(rf'<!-- From pip[^>]*\b{PIP.get(module, module).replace("_", "-")}\b', notes), module


def test_pip_installs_what_is_imported(package):
    arguments = setup_arguments(package)
    extras = [name for extra, names in arguments['extras_require'].items() if extra != 'test' for name in names]
    requires = {re.sub(r'[-_.]+', '-', name.lower()) for name in arguments.get('install_requires', []) + extras}
    distributions = {'yaml': 'pyyaml', 'rclpy': 'rclpy', **PIP}
    for module in imported(package):
        if module in NAMES:
            assert module.replace('_', '-') in requires
        elif not is_ros(module) or module == 'rclpy':
            assert distributions.get(module, module).replace('_', '-') in requires


def test_type_checkers_see_its_types(package):
    assert (package / package.name / 'py.typed').is_file()
    assert "['py.typed'" in (package / 'setup.py').read_text()


def test_the_tools_know_all_packages():
    tools = tomllib.loads((ROOT / 'pyproject.toml').read_text())['tool']
    tested = {Path(path).parts[2] for path in tools['pytest']['ini_options']['testpaths'] if path != 'tests'}
    assert tested == {package.name for package in PACKAGES if (package / 'test').is_dir()}
    assert set(tools['mypy']['packages']) == NAMES - {'panda_tray_description'}


@pytest.mark.parametrize('node', ['torque_ctrl_node.node', 'shared_control_nodes.bridge.node'])
def test_what_drives_a_robot_loads_nothing_heavy(node):
    heavy = {'torch', 'stable_baselines3', 'gymnasium', 'pybullet', 'mujoco', 'pandas', 'matplotlib', 'scipy',
             'nicegui'}
    loaded = subprocess.run([sys.executable, '-c', f'import {node}, sys; print(*sys.modules)'],
                            capture_output=True, text=True, check=True).stdout.split()
    assert not heavy & {name.split('.')[0] for name in loaded}


def test_no_docstring_begins_with_of():
    """Half a sentence, which a reader has to complete from the name above it."""
    sources = [path for package in PACKAGES for path in package.rglob('*.py')]
    assert not [path for path in sources if re.search(r'^\s*"""Of ', path.read_text(), re.MULTILINE)]


def test_every_source_has_the_header_that_ament_copyright_asks_for():
    headers = {path: path.read_text()[:200] for package in PACKAGES for path in package.rglob('*.py')
               if path.name != 'setup.py' and path.read_text()}
    assert not [path for path, header in headers.items()
                if not re.match(r'(#!.*\n\n?)?# Copyright 20\d\d .+\n#\n# Licensed under the Apache License', header)]


def test_package_xml_is_as_the_build_tools_want_it(package):
    warnings = []
    parse_package(package, warnings=warnings).validate(warnings=warnings)
    assert not warnings


def test_the_wheel_is_whole(tmp_path):
    """Every console script and the README's Python run from it; `make wheel` also resolves what it needs."""
    done = subprocess.run([sys.executable, ROOT / 'tools' / 'wheel.py', '--quick', '--output', tmp_path], timeout=900,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    scripts = {name for package in PACKAGES for name in re.findall(
        r"'(\S+) = \S+:main'", (package / 'setup.py').read_text())}
    assert set(re.findall(r'^(\S+) --help: ok$', done.stdout, re.MULTILINE)) == scripts
    assert 'the Python of README.md: ok' in done.stdout


@pytest.mark.parametrize('package', PACKAGES, ids=lambda package: package.name)
def test_files_are_read_and_written_alike_whatever_the_locale_says(package):
    """A report ended in "'ascii' codec can't decode" where the locale was not of UTF-8."""
    said = []
    for path in package.glob(f'{package.name}/**/*.py') if package.name != 'shared_control_testing' else ():
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            named = {keyword.arg for keyword in node.keywords}
            mode = next((argument.value for argument in node.args if isinstance(argument, ast.Constant)), '')
            is_text = node.func.attr in ('read_text', 'write_text') or (
                node.func.attr == 'open' and (mode in ('r', 'w', 'a', 'x') or 'newline' in named))
            if is_text and 'encoding' not in named:
                said.append(f'{path.relative_to(ROOT)}:{node.lineno}')
    assert said == [], "encoding='utf-8' is missing"
