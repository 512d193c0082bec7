"""The examples: small, complete, installed by pip from their own folder, and at work."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest
import rclpy
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_testing.nodes import domain_id

__all__ = ['domain_id']

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted(path.parent for path in (ROOT / 'examples').glob('*/pyproject.toml'))
LINES_MAX = 150
PAGES = {'two_axis_task': 'task', 'analog_device': 'device', 'cross_entropy_learner': 'learner',
         'point_mass_world': 'world'}
"""The pages of docs/how_to that explain them."""


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """Variables of a process that has all examples, installed from copies that stand alone."""
    copies, target = tmp_path_factory.mktemp('copies'), tmp_path_factory.mktemp('target')
    for example in EXAMPLES:
        shutil.copytree(example, copies / example.name)
    subprocess.run([sys.executable, '-m', 'pip', 'install', '--quiet', '--no-index', '--no-deps',
                    '--no-build-isolation', '--target', target, *copies.iterdir()], check=True, timeout=120)
    return {'PYTHONPATH': str(target), 'OMP_NUM_THREADS': '1'}


@pytest.mark.parametrize('example', EXAMPLES, ids=lambda path: path.name)
def test_an_example_is_small_and_names_what_it_adds(example):
    files = [path for path in example.rglob('*') if path.suffix in ('.py', '.toml', '.yaml', '.urdf', '.md')
             and 'build' not in path.parts]
    assert {'pyproject.toml', 'README.md'} <= {path.name for path in files}
    assert sum(len(path.read_text().splitlines()) for path in files) <= LINES_MAX
    project = tomllib.loads((example / 'pyproject.toml').read_text())['project']
    assert len(project['entry-points']) == 1


@pytest.mark.parametrize(('name', 'page'), PAGES.items())
def test_a_page_shows_what_the_example_says(name, page):
    text = (ROOT / 'docs' / 'how_to' / f'{page}.md').read_text()
    blocks = re.findall(r'^```(?:python|toml)\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
    sources = [path.read_text() for path in (ROOT / 'examples' / name).iterdir() if path.suffix in ('.py', '.toml')]
    assert blocks
    for block in blocks:
        assert any(block in source for source in sources), block


@pytest.mark.parametrize('arguments', [
    ('--task', 'two_axis'), ('--preset', 'cross_entropy'), ('--physics', 'point_mass'),
    ('--task', 'two_axis', '--preset', 'cross_entropy', '--physics', 'point_mass')], ids=' '.join)
def test_it_trains(arguments, installed, tmp_path):
    command = [sys.executable, '-m', 'shared_control', 'train', *arguments, '--output', str(tmp_path / 'run'),
               '--json', str(tmp_path / 'result.json'), '--evaluate-every', '0']
    for episodes, more in ((1, []), (2, ['--resume', str(tmp_path / 'run')])):
        subprocess.run([*command, '--episodes', str(episodes), *more], env=os.environ | installed, check=True,
                       timeout=120)
        assert json.loads((tmp_path / 'result.json').read_text())['episodes'] == episodes


def test_gymnasium_makes_the_task(installed):
    code = ('import gymnasium, shared_control\n'
            'from gymnasium.utils.env_checker import check_env\n'
            'env = gymnasium.make("shared_control/TwoAxis-v0", physics="point_mass", episode_seconds=1.0)\n'
            'check_env(env.unwrapped)\n'
            'print(env.action_space.shape, env.observation_space.shape)')
    said = subprocess.run([sys.executable, '-c', code], env=os.environ | installed, capture_output=True, text=True,
                          check=True)
    assert said.stdout.splitlines()[-1] == '(2,) (6,)'


class Person:
    """Holds a stick, and hears what becomes of it."""

    def __init__(self, domain):
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = Node('person', context=self._context)
        self._sticks = self._node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
        self._wrenches = Polled(self._node, contract.HUMAN_WRENCH, depth=500)

    def hold(self, axes, wanted):
        """Repeat a state of the stick (none when None) until the moment is ``wanted``, x and y, N m."""
        found, deadline = None, time.monotonic() + 60.0
        while found != wanted:
            assert time.monotonic() < deadline, f'waited for {wanted} N m, the last was {found}'
            if axes is not None:
                self._sticks.publish(Joy(axes=axes))
            message: WrenchStamped | None = self._wrenches.wait(0.05)
            if message is not None:
                found = round(message.wrench.torque.x, 3), round(message.wrench.torque.y, 3)

    def close(self):
        self._node.destroy_node()
        self._context.try_shutdown()


@pytest.mark.parametrize(('task', 'left', 'up'), [('balance', (0.0, 10.0), (0.0, 0.0)),
                                                  ('two_axis', (0.0, 10.0), (10.0, 0.0))])
def test_a_stick_moves_the_axes_of_the_task(task, left, up, installed, domain_id):
    command = [sys.executable, '-m', 'teleop_key_node.node', '--ros-args', '-p', 'device:=stick', '-p', f'task:={task}',
               '-p', 'screen:=off']
    process = subprocess.Popen(command, env=os.environ | installed)
    person = Person(domain_id)
    try:
        person.hold([1.0, 0.0], left)
        person.hold([0.05, -0.05], (0.0, 0.0))  # within the dead band
        person.hold([0.0, 1.0], up)
        person.hold([-0.55, 0.0], (0.0, -5.0))
        person.hold(None, (0.0, 0.0))  # silent: it takes its moment with it
    finally:
        process.terminate()
        assert process.wait(60) == 0
        person.close()
