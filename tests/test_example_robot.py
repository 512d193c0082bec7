"""The example of docs/how_to/robot.md: an arm of six joints that no file of ours knows."""

import re
import shutil
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import JointState, Joy
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import load_robot
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from shared_control_sim.local_plant import LocalPlant

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
    assert node.process.wait(60) != 0
    assert "parameter 'robot': no robot 'nobody'" in node.log()


def test_the_plant_in_process_holds_it_too(ur5):
    plant = LocalPlant(robot=ur5)
    plant.reset(0)
    for _ in range(50):
        state = plant.advance(np.array([5.0]))
    plant.close()
    off = np.abs(state.q - ur5.home)
    assert 0.001 < off.max() < 0.1, 'held, and turned by the moment'


class TestTheGraphOfAnotherRobot:
    """Simulator, controller, keys: each is given the robot by its name."""

    def test_the_moment_of_the_keys_reaches_the_arm(self, ur5, start_node, observer):
        for node, parameters in (('torque_ctrl_node', {'enabled': True}), ('panda_sim_node', {'paced': False}),
                                 ('teleop_key_node', {'use_sim_time': True})):
            start_node(node, robot='ur5', **parameters)
        states, used = observer.listen(contract.JOINT_STATES_THROTTLE), observer.listen(contract.HUMAN_APPLIED)
        keys = observer.publisher(contract.KEYS)

        def held():
            keys.publish(joy)
            return used and used[-1].wrench.torque.y == 5.0

        joy = Joy(buttons=[0, 0, 0])
        joy.header.frame_id = 'test'
        observer.spin(lambda: held() is not None and states and keys.get_subscription_count())
        joy.buttons = [1, 0, 0]
        observer.spin(held, 120.0, 'the moment of the key')
        assert list(states[-1].name) == list(ur5.joints) and used[-1].header.frame_id == 'base_link'
        assert np.abs(np.array(states[-1].position) - ur5.home).max() < 0.1, 'the controller holds the arm'
