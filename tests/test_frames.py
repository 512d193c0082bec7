"""What the simulator publishes, put through the URDF, is where the simulator has arm, tray and ball."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pybullet
import pytest
from builtin_interfaces.msg import Time
from panda_tray_description import URDF_PATH
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda
from shared_control_nodes.view.transforms import arm_transforms, ball_transform
from shared_control_ros import contract
from shared_control_ros.joints import joint_positions
from shared_control_ros.stamps import to_ns
from shared_control_ros.state_publisher import StatePublisher
from shared_control_sim.bullet import BulletWorld
from urdf_parser_py.urdf import URDF

TOLERANCE = 1e-6
"""m, and of the entries of rotation matrices"""


@pytest.fixture(scope='module')
def robot():
    return URDF.from_xml_string(URDF_PATH.read_bytes())


@pytest.fixture
def world():
    world = BulletWorld()
    yield world
    world.close()


def rotation_about(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def forward_kinematics(robot, positions):
    """Pose of every link in the base frame from what urdf_parser_py read: 4 x 4 matrices by link."""
    poses = {robot.get_root(): np.eye(4)}
    waiting = list(robot.joints)
    while waiting:
        joint = next(j for j in waiting if j.parent in poses)
        waiting.remove(joint)
        step = np.eye(4)
        roll, pitch, yaw = joint.origin.rpy or (0, 0, 0)
        step[:3, :3] = (rotation_about((0, 0, 1), yaw) @ rotation_about((0, 1, 0), pitch)
                        @ rotation_about((1, 0, 0), roll))
        step[:3, 3] = joint.origin.xyz
        if joint.type == 'revolute':
            step[:3, :3] = step[:3, :3] @ rotation_about(joint.axis, positions[joint.name])
        poses[joint.child] = poses[joint.parent] @ step
    return poses


def chained(transforms, root):
    """Pose of every frame in ``root``, as a listener to /tf puts it together."""
    poses = {root: np.eye(4)}
    for transform in transforms:
        t, r = transform.transform.translation, transform.transform.rotation
        step = np.eye(4)
        step[:3, :3] = np.reshape(pybullet.getMatrixFromQuaternion([r.x, r.y, r.z, r.w]), (3, 3))
        step[:3, 3] = t.x, t.y, t.z
        poses[transform.child_frame_id] = poses[transform.header.frame_id] @ step
    return poses


def link_poses(world):
    """Pose of every link in the base frame, as PyBullet has it."""
    poses = {}
    for index in range(pybullet.getNumJoints(world.arm, physicsClientId=world.client)):
        name = pybullet.getJointInfo(world.arm, index, physicsClientId=world.client)[12].decode()
        state = pybullet.getLinkState(world.arm, index, computeForwardKinematics=True, physicsClientId=world.client)
        poses[name] = np.eye(4)
        poses[name][:3, :3] = np.reshape(pybullet.getMatrixFromQuaternion(state[5]), (3, 3))
        poses[name][:3, 3] = state[4]
    return poses


def test_description_transforms_and_odometry_agree_with_the_simulator(observer, robot, world):
    published = StatePublisher(observer.node, world)
    states, balls = observer.listen(contract.JOINT_STATES_THROTTLE), observer.listen(contract.BALL)
    torque = world.effort + [2.0, -6.0, 3.0, 5.0, -1.0, 2.0, 1.0]
    for tick in range(1, 101):
        world.step(torque)
        if tick % 50:
            continue
        published.publish(tick * 1_000_000, world.effort)
        observer.spin(lambda tick=tick: len(states) == len(balls) == tick // 50, what='the state that was published')
        assert to_ns(states[-1].header.stamp) == to_ns(balls[-1].header.stamp) == tick * 1_000_000

        simulated = link_poses(world)
        q = joint_positions(states[-1], panda())
        seen = chained([*arm_transforms(RobotModel(), q, Time()), ball_transform(balls[-1])], contract.BASE_FRAME)
        parsed = forward_kinematics(robot, dict(zip(states[-1].name, states[-1].position, strict=True)))
        assert set(simulated) == set(seen) - {'panda_link0', 'ball'} == set(parsed) - {'panda_link0'}
        for link, pose in simulated.items():
            np.testing.assert_allclose(seen[link], pose, atol=TOLERANCE, err_msg=link)
            np.testing.assert_allclose(parsed[link], pose, atol=TOLERANCE, err_msg=link)
        np.testing.assert_allclose(seen['ball'][:3, 3], world.ball_state()[0], atol=TOLERANCE)
    assert np.abs(q - joint_positions(states[0], panda())).max() > 0.05, 'the arm was meant to move'


def test_check_urdf_accepts_the_description():
    command = shutil.which('check_urdf', path=Path(sys.executable).parent) or shutil.which('check_urdf')
    assert command, 'check_urdf comes with pin (cmeel-urdfdom)'
    said = subprocess.run([command, URDF_PATH], capture_output=True, text=True, timeout=60, check=True).stdout
    assert 'Successfully Parsed XML' in said and 'panda_tray' in said
