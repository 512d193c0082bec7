"""The launch files: built where ``launch`` is installed, and read with ``ast`` anywhere."""

import ast
import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

PACKAGE = Path(__file__).parents[1]
PACKAGES = PACKAGE.parent
FILES = sorted((PACKAGE / 'launch').glob('*.launch.py'))
LAUNCHING = ast.parse((PACKAGE / 'shared_control_bringup' / 'launching.py').read_text())
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


def parameters_of(package):
    """Parameters that a node declares."""
    trees = [ast.parse(path.read_text()) for path in (PACKAGES / package / package).glob('*.py')]
    return {'use_sim_time'} | {call.args[1].value for tree in trees for call in calls(tree, 'declare')}


def console_scripts(package):
    setup = PACKAGES / package / 'setup.py'
    return re.findall(r"'(\S+) = \S+:main'", setup.read_text()) if setup.exists() else []


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


def test_nodes_and_their_parameters_exist(tree):
    for call in calls(tree, 'graph_node'):
        if not isinstance(call.args[0], ast.Constant):
            continue
        package = call.args[0].value
        assert console_scripts(package) == [package]
        for keyword in call.keywords:
            if keyword.arg == 'parameters':
                names = {key.value for key in keyword.value.keys if key is not None}
                assert names <= parameters_of(package), package


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
    tree = ast.parse((PACKAGE / 'launch' / 'node.launch.py').read_text())
    listed = next(ast.literal_eval(item.value) for item in tree.body
                  if isinstance(item, ast.Assign) and item.targets[0].id == 'NODES')
    depends = ElementTree.parse(PACKAGE / 'package.xml').iter('exec_depend')
    assert sorted(listed) == sorted(depend.text for depend in depends if depend.text.endswith('_node'))
    assert all(console_scripts(node) == [node] for node in listed)


def test_the_readme_lists_the_files_and_their_arguments():
    readme = (PACKAGE / 'README.md').read_text()
    rows = dict(re.findall(r'^\| `(\w+\.launch\.py)` \|[^|]*\| (.*?) \|$', readme, re.MULTILINE))
    assert set(rows) == {path.name for path in FILES}
    for path in FILES:
        own = set(declared(ast.parse(path.read_text()))) - {'params_file', 'namespace'}
        assert set(re.findall(r'`(\w+)`', rows[path.name])) == own


def test_launch_files_need_no_packages_from_pip():
    """``ros2 launch`` runs on the system's Python, which has none; nodes run on that of their scripts."""
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
    spec = importlib.util.spec_from_file_location(path.stem.replace('.', '_'), path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    description = module.generate_launch_description()
    arguments = {argument.name: argument.description for argument, inclusions
                 in description.get_launch_arguments_with_include_launch_description_actions() if not inclusions}
    expected = declared(ast.parse(path.read_text()))
    assert set(arguments) == set(expected)
    assert all(arguments[name].startswith(text) for name, text in expected.items())
