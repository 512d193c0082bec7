"""The example of docs/how_to/robot.md: an arm of six joints that no file of ours knows."""

import re
import shutil
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import load_robot
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns

EXAMPLE = Path(__file__).parents[1] / 'examples' / 'ur5_robot'


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """The folder that the example is installed into."""
    source, target = tmp_path_factory.mktemp('example') / 'ur5_robot', tmp_path_factory.mktemp('target')
    shutil.copytree(EXAMPLE, source)
    subprocess.run([sys.executable, '-m', 'pip', 'install', '--quiet', '--no-deps', '--no-build-isolation', '--target',
                    target, source], check=True)
    return target


@pytest.fixture
def ur5(installed, monkeypatch):
    """The robot as the example describes it; processes find it by name."""
    monkeypatch.setenv('PYTHONPATH', str(installed), prepend=':')
    spec = spec_from_file_location('ur5_robot', installed / 'ur5_robot' / '__init__.py')
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return load_robot(str(module.UR5))


def test_the_example_is_short():
    files = [path for path in EXAMPLE.rglob('*') if path.suffix in ('.py', '.toml', '.yaml', '.urdf')]
    assert sum(len(path.read_text().splitlines()) for path in files) <= 150


def test_computed_torque_holds_it(ur5):
    said = subprocess.run([sys.executable, EXAMPLE / 'hold.py'], capture_output=True, text=True, check=True).stdout
    off, speed = map(float, re.search(r'ur5: (\S+) rad off, (\S+) rad/s', said).groups())
    assert 0.001 < off < 0.1 and speed < 0.1


def test_the_controller_node_answers_six_joints_with_six_torques(ur5, start_node, observer):
    start_node('torque_ctrl_node', robot='ur5', enabled=True)
    commands, applied = observer.listen(contract.EFFORT_COMMANDS), observer.listen(contract.APPLIED_WRENCH)
    states = observer.publisher(contract.JOINT_STATES)
    observer.spin(lambda: states.get_subscription_count())
    gravity = RobotModel(ur5).gravity(ur5.home)
    message = JointState(name=list(ur5.joints), position=ur5.home.tolist(), velocity=[0.0] * ur5.dof,
                         effort=gravity.tolist())
    for tick in range(1, 51):
        set_ns(message.header.stamp, tick * 1_000_000)
        states.publish(message)
        observer.spin_for(0.02)
    observer.spin(lambda: commands and applied)
    torque = np.array(commands[-1].data)
    np.testing.assert_allclose(torque, gravity, atol=1e-9)
    assert (np.abs(torque) <= ur5.torque_max).all()
    assert applied[-1].header.frame_id == 'base_link'


def test_an_unknown_robot_is_refused(start_node):
    node = start_node('torque_ctrl_node', robot='nobody')
    assert node.process.wait(30) != 0
    assert "parameter 'robot': no robot 'nobody'" in node.log()
