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

"""The launch files: built where ``launch`` is installed, and anywhere read with ``ast`` and built with a stand-in."""

import ast
import importlib.util
import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest
from shared_control_bringup.graph import ALL_NODES, overrides
from shared_control_bringup.parameters import DEFAULTS, load
from shared_control_bringup.settings import TUTORS, Settings
from shared_control_ros.declarations import declared_parameters
from shared_control_ros.processes import node_module

PACKAGE = Path(__file__).parents[1]
PACKAGES = PACKAGE.parent
FILES = sorted((PACKAGE / 'launch').glob('*.launch.py'))
LAUNCHING = ast.parse((PACKAGE / 'shared_control_bringup' / 'launching.py').read_text())
ARGUMENTS = {
    'tutor': 'keyboard', 'profile': 'expert', 'task': 'balance', 'preset': '', 'physics': 'bullet', 'episodes': '0',
    'minutes': '45', 'seed': '0', 'page': '127.0.0.1:8088', 'output': 'out/session', 'node': 'torque_ctrl_node',
    'params_file': str(DEFAULTS)}
HELPERS = {item.name: item for item in LAUNCHING.body if isinstance(item, ast.FunctionDef)}


def calls(tree, name):
    """Calls of a function, wherever they are."""
    return [node for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == name]


def declared(tree):
    """Arguments that a launch file declares, its helpers' included, and their descriptions."""
    found = {}
    for helper in ('common_arguments', 'view_argument'):
        if calls(tree, helper):
            found |= declared(HELPERS[helper])
    for call in calls(tree, 'DeclareLaunchArgument'):
        keywords = {keyword.arg: keyword.value for keyword in call.keywords}
        found[call.args[0].value] = ast.literal_eval(keywords['description'])
    return found


def used(tree):
    """Arguments that a launch file or one of its helpers asks for."""
    found = {call.args[0].value for call in calls(tree, 'LaunchConfiguration')}
    for name, helper in HELPERS.items():
        if calls(tree, name):
            found |= used(helper)
    return found


def console_scripts(package):
    setup = PACKAGES / package / 'setup.py'
    return re.findall(r"'(\S+) = \S+:main'", setup.read_text()) if setup.exists() else []


class StandIn:
    """Any class of ``launch`` or ``launch_ros``: remembers how it was made."""

    def __init__(self, *args, **kwargs):
        self.args, self.kwargs = args, kwargs

    def perform(self, context):
        """As a LaunchConfiguration or a PathJoinSubstitution."""
        return context[self.args[0]]


def nodes_in(item, context):
    """Nodes that an action starts, in their order."""
    if isinstance(item, list | tuple):
        return [node for part in item for node in nodes_in(part, context)]
    if not isinstance(item, StandIn):
        return []
    if type(item).__name__ == 'Node':
        return [item]
    if type(item).__name__ == 'OpaqueFunction':
        return nodes_in(item.kwargs['function'](context), context)
    return nodes_in(item.args, context)


def given_to(node):
    """Parameters that a launch file gives a node on top of its files."""
    values = node.kwargs['parameters'][-1]
    return {name: value.args[0] if isinstance(value, StandIn) else value for name, value in values.items()
            } if isinstance(values, dict) else {}


@pytest.fixture
def started(monkeypatch):
    """``started(file, **arguments)``: the nodes that a launch file starts, with a stand-in for ``launch``."""
    for name in ('launch', 'launch.actions', 'launch.conditions', 'launch.event_handlers', 'launch.events.process',
                 'launch.substitutions', 'launch_ros.actions', 'launch_ros.parameter_descriptions',
                 'launch_ros.substitutions'):
        module = ModuleType(name)
        module.__getattr__ = lambda attribute: type(attribute, (StandIn,), {})
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setitem(sys.modules, 'shared_control_bringup.launching', loaded(
        PACKAGE / 'shared_control_bringup' / 'launching.py', 'shared_control_bringup.launching'))

    def start(file, **arguments):
        description = loaded(PACKAGE / 'launch' / file).generate_launch_description()
        return nodes_in(description.args, arguments)

    return start


def loaded(path, name=''):
    """The module in a file."""
    spec = importlib.util.spec_from_file_location(name or path.stem.replace('.', '_'), path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(params=FILES, ids=lambda path: path.name)
def tree(request):
    return ast.parse(request.param.read_text())


def test_arguments_are_declared_with_a_description_and_used(tree):
    assert used(tree) == set(declared(tree))
    assert all(description.endswith('.') for description in declared(tree).values())


def test_helpers_and_the_names_they_are_called_by_exist(tree):
    for item in tree.body:
        if isinstance(item, ast.ImportFrom) and item.module == 'shared_control_bringup.launching':
            known = set(HELPERS) | {t.id for a in LAUNCHING.body if isinstance(a, ast.Assign) for t in a.targets}
            assert {name.name for name in item.names} <= known


def test_nodes_and_their_parameters_exist(started):
    for path in FILES:
        for node in started(path.name, **{**ARGUMENTS, 'tutor': 'sim'}):
            package, name = node.kwargs['package'], node.kwargs['executable']
            if (PACKAGES / package).is_dir():
                assert name in console_scripts(package)
                assert set(given_to(node)) <= {'use_sim_time', *declared_parameters(name)}, name


def test_a_session_refuses_what_it_would_not_go_by(started, tmp_path):
    (tmp_path / 'mine.yaml').write_text('torque_ctrl_node: {ros__parameters: {moment_limit: 5.0}}')
    with pytest.raises(ValueError, match="parameter 'moment_limit' of torque_ctrl_node is"):
        started('session.launch.py', **{**ARGUMENTS, 'params_file': str(tmp_path / 'mine.yaml')})


def test_a_session_says_which_python_it_needs(started, monkeypatch):
    """That of ``ros2`` is the system's, which has no packages from pip."""
    def resolved(_):
        raise ModuleNotFoundError("No module named 'pinocchio'", name='pinocchio')

    monkeypatch.setattr(Settings, 'resolved', resolved)
    with pytest.raises(RuntimeError, match=r"'pinocchio'.*VENV/bin/python \$\(which ros2\) launch"):
        started('session.launch.py', **ARGUMENTS)


@pytest.mark.parametrize('tutor', TUTORS)
def test_a_launch_starts_the_nodes_that_a_session_starts(started, tutor):
    arguments = {**ARGUMENTS, 'tutor': tutor, 'seed': '7', 'page': '0.0.0.0:9000'}
    nodes = started('session.launch.py', **arguments)
    settings = Settings(tutor=tutor, seed=7, page=('0.0.0.0', 9000)).resolved()
    expected = overrides(settings, Path('out/session'), shows_screen=tutor == 'keyboard')
    assert {node.kwargs['executable']: given_to(node) for node in nodes} == expected
    assert [node.kwargs['executable'] for node in nodes] == list(expected)
    assert all(node.kwargs['parameters'][0] == str(DEFAULTS) for node in nodes)


def test_the_controller_is_enabled_beside_a_simulator_only(started):
    assert all('enabled' not in values for values in load().values())
    for path in FILES:
        nodes = {node.kwargs['executable']: given_to(node) for node in started(path.name, **ARGUMENTS)}
        if 'torque_ctrl_node' in nodes:
            assert nodes['torque_ctrl_node']['enabled'] is ('panda_sim_node' in nodes), path.name
    # When it is started again it has the same parameters: alone it stays disabled whatever the file says.
    alone, = started('node.launch.py', node='torque_ctrl_node')
    assert alone.kwargs['respawn'] is True and given_to(alone) == {'enabled': False}
    other, = started('node.launch.py', node='teleop_key_node')
    assert given_to(other) == {}


def test_files_in_the_share_folder_exist(tree):
    for call in [*calls(tree, 'PathJoinSubstitution'), *calls(LAUNCHING, 'PathJoinSubstitution')]:
        first, *parts = call.args[0].elts
        if ast.unparse(first) == 'SHARE':
            path = PACKAGE.joinpath(*(part.value for part in parts))
            assert path.is_file()
            assert repr(path.parent.name) in (PACKAGE / 'setup.py').read_text()


def test_views_are_started_with_arguments_that_they_have(tree):
    known = declared(ast.parse((PACKAGE / 'launch' / 'view.launch.py').read_text()))
    for call in calls(tree, 'view'):
        assert {keyword.arg for keyword in call.keywords} <= set(known)


def test_one_node_alone_can_be_any_node():
    depends = {depend.text for depend in ElementTree.parse(PACKAGE / 'package.xml').iter('exec_depend')}
    for node in ALL_NODES:
        assert node_module(node).partition('.')[0] in {*depends, PACKAGE.name}
    installed = {script.name for script in entry_points(group='console_scripts') if script.name.endswith('_node')}
    assert set(ALL_NODES) == installed


def test_the_readme_lists_the_files_and_their_arguments():
    readme = (PACKAGE / 'README.md').read_text()
    rows = dict(re.findall(r'^\| `(\w+\.launch\.py)` \|[^|]*\| (.*?) \|$', readme, re.MULTILINE))
    assert set(rows) == {path.name for path in FILES}
    for path in FILES:
        own = set(declared(ast.parse(path.read_text()))) - {'params_file', 'namespace'}
        assert set(re.findall(r'`(\w+)`', rows[path.name])) == own


def test_launch_files_need_no_packages_from_pip():
    """``ros2 launch`` runs on the system's Python, which has none; nodes run on that of their scripts.

    When it starts, that of a session needs them all the same (above); its arguments can be shown without.
    """
    lines = {ast.unparse(item) for path in [*FILES, PACKAGE / 'shared_control_bringup' / 'launching.py']
             for item in ast.parse(path.read_text()).body if isinstance(item, ast.ImportFrom) and not item.level
             and not item.module.startswith(('launch', 'shared_control_bringup.launching'))}
    heavy = ('torch', 'gymnasium', 'pinocchio', 'pybullet', 'rosbags', 'mcap', 'stable_baselines3')
    script = '\n'.join([*lines, 'import shared_control_bringup.parameters, shared_control_bringup.node_process, sys',
                        f'print([name for name in {heavy} if name in sys.modules])'])
    ran = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True, timeout=60, check=True)
    assert ran.stdout.splitlines()[-1] == '[]'


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_the_description_builds(path):
    # Not 'launch' alone: started in the package's folder, Python takes its launch/ for a package.
    pytest.importorskip('launch_ros.actions', reason='PyPI has no launch; a ROS install has')
    description = loaded(path).generate_launch_description()
    arguments = {argument.name: argument.description for argument, inclusions
                 in description.get_launch_arguments_with_include_launch_description_actions() if not inclusions}
    expected = declared(ast.parse(path.read_text()))
    assert set(arguments) == set(expected)
    assert all(arguments[name].startswith(text) for name, text in expected.items())
