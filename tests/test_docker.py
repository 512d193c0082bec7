"""The files for Docker, as far as they can be checked without an engine: nothing here builds or runs an image."""

import json
import re
import shlex
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from shared_control_bringup.graph import Role, nodes_of, overrides
from shared_control_bringup.node_process import REAL_TIME_PRIORITY
from shared_control_bringup.parameters import load
from shared_control_bringup.settings import Settings
from shared_control_ros.declarations import declared_parameters

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / 'ros2_ws' / 'src'
DOCKERFILES = sorted((ROOT / 'docker').glob('*.Dockerfile'))
HOME = '/shared-control/'
COMPOSE = yaml.safe_load((ROOT / 'docker' / 'compose.yaml').read_text())
SCRIPTS = {name for setup in SOURCES.glob('*/setup.py')
           for name in re.findall(r"'(\S+) = \S+:main'", setup.read_text())}


def instructions(dockerfile):
    """Instructions and their arguments."""
    text = re.sub(r'^\s*#.*\n', '', dockerfile.read_text(), flags=re.MULTILINE).replace('\\\n', ' ')
    return [tuple(line.split(maxsplit=1)) for line in text.splitlines() if line.strip()]


def in_image(path):
    """The file of the repository that has this path in an image."""
    assert path.startswith(HOME)
    return ROOT / path.removeprefix(HOME)


def ignored(path):
    patterns = [line.removeprefix('**/') for line in (ROOT / '.dockerignore').read_text().split()]
    return any(fnmatch(part, pattern) for part in path.relative_to(ROOT).parts for pattern in patterns)


@pytest.fixture(params=DOCKERFILES, ids=lambda path: path.name)
def dockerfile(request):
    return request.param


def test_hadolint_has_nothing_to_say(dockerfile):
    hadolint = Path(sys.executable).parent / 'hadolint'
    said = subprocess.run([hadolint, '--no-color', dockerfile], capture_output=True, text=True, timeout=60)
    assert said.returncode == 0 and not said.stdout + said.stderr


def test_what_is_copied_is_there(dockerfile):
    for name, arguments in instructions(dockerfile):
        if name == 'COPY':
            *sources, _ = arguments.split()
            assert all((ROOT / source).exists() and not ignored(ROOT / source) for source in sources)
    for path in (*SOURCES.glob('*/package.xml'), *(SOURCES / 'shared_control_bringup' / 'launch').iterdir()):
        assert not ignored(path)


def test_what_is_started_is_there(dockerfile):
    for name, arguments in instructions(dockerfile):
        if name == 'ENTRYPOINT':
            script = in_image(json.loads(arguments)[0])
            assert script.stat().st_mode & 0o111
            subprocess.run(['bash', '-n', script], check=True, timeout=10)
        elif name == 'CMD':
            assert json.loads(arguments)[0] in SCRIPTS | {'bash'}


def test_the_image_with_ros_leaves_ros_to_debian():
    """The filter of ros.Dockerfile takes out ROS, and nothing else."""
    command = next(a for n, a in instructions(ROOT / 'docker' / 'ros.Dockerfile') if n == 'RUN' and 'grep' in a)
    pattern = re.search(r"grep --invert-match '(.+?)'", command).group(1)
    kept = [line for line in (ROOT / 'requirements.txt').read_text().splitlines() if not re.search(pattern, line)]
    assert not [line for line in kept if 'rclpy' in line or 'rmw' in line or '-msgs' in line]
    names = {line.split('==')[0] for line in kept}
    assert {'rosbags', 'pin', 'pybullet', 'torch', 'mcap', 'colcon-core', 'setuptools'} <= names


@pytest.mark.parametrize('name', COMPOSE['services'])
def test_a_service_is_a_node_that_exists(name):
    service = COMPOSE['services'][name]
    words = shlex.split(service['command'])
    if words[0] == 'chrt':
        assert shutil.which('chrt') and service['ulimits']['rtprio'] >= int(words[2])
        words = words[3:]
    assert words[0] in SCRIPTS
    assert words[1] == '--ros-args'
    file = in_image(words[words.index('--params-file') + 1])
    assert f'/{words[0]}' in ''.join(yaml.safe_load(file.read_text()))
    assert all(value.startswith('out/') for value in re.findall(r'output:=(\S+)', service['command']))
    assert set(service.get('depends_on', [])) <= set(COMPOSE['services'])


def test_the_services_are_a_session_with_a_simulated_tutor():
    """Who takes part, what each is given, and who runs in the control loop: as the table of a session has it."""
    taking_part = {}
    for service in COMPOSE['services'].values():
        if 'profiles' not in service:
            words = shlex.split(service['command'])
            taking_part[next(word for word in words if word in SCRIPTS)] = words
    nodes = nodes_of('sim')
    assert set(taking_part) == {node.name for node in nodes}
    expected = overrides(Settings(tutor='sim', episodes=6), Path('out/docker'), shows_screen=False)
    for node in nodes:
        words = taking_part[node.name]
        assert (words[:3] == ['chrt', '--rr', str(REAL_TIME_PRIORITY)]) is (node.role is Role.CONTROL_LOOP)
        given = dict(word.split(':=', 1) for flag, word in pairwise(words) if flag == '-p')
        found = {**declared_parameters(node.name), **load()[node.name],
                 **{name: yaml.safe_load(value) if name != 'screen' else value for name, value in given.items()}}
        for name, value in expected[node.name].items():
            assert found[name] == value, f'{node.name}: {name}'


@pytest.mark.parametrize('name', COMPOSE['services'])
def test_a_service_can_talk_to_the_others(name):
    service = COMPOSE['services'][name]
    assert service['network_mode'] == service['ipc'] == 'host'
    assert in_image(service['environment']['FASTRTPS_DEFAULT_PROFILES_FILE']).is_file()
    for image in ('ros', 'pip'):
        path = service['build']['dockerfile'].replace('${IMAGE:-ros}', image)
        assert (ROOT / 'docker' / service['build']['context'] / path).is_file()


def test_the_dev_container_is_the_image_with_ros():
    folder = ROOT / '.devcontainer'
    container = json.loads((folder / 'devcontainer.json').read_text())
    assert (folder / container['build']['dockerfile']).resolve() == ROOT / 'docker' / 'ros.Dockerfile'
    assert (folder / container['build']['context']).resolve() == ROOT
    assert {'--network=host', '--ipc=host'} <= set(container['runArgs'])
    assert container['workspaceFolder'] + '/' == HOME
    build = 'colcon build --merge-install --base-paths src'
    assert build in container['postCreateCommand'] and build in (ROOT / 'docker' / 'ros.Dockerfile').read_text()
