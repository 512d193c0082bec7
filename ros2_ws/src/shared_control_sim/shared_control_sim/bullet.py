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

"""PyBullet: the arm, the tray on its flange, and a ball."""

from operator import itemgetter
from tempfile import NamedTemporaryFile
from xml.etree import ElementTree

import numpy as np
from shared_control.not_copied import NotCopied
from shared_control.robot.model import GRAVITY
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying
from shared_control.scene import Ball, Scene
from shared_control.streams import muted
from shared_control.tasks.balance import BALANCE

with muted():  # it prints when it was built
    import pybullet

_POSITION, _VELOCITY = itemgetter(0), itemgetter(1)
_CLOSED = -1
"""Parts of the state of a joint as PyBullet gives it."""


class BulletWorld(NotCopied):
    """An arm that takes joint torques, with a ball on its tray.

    An episode depends on nothing that came before it: :meth:`reset` restores a saved state of the whole world,
    because PyBullet keeps contacts and torques when only bodies are put back. Two worlds given the same torques from
    the same start go through the same states, bit for bit.

    Args:
        scene: the tray and the ball.
        dt: length of a tick, s.
        spec: the robot; the Panda when not given.
    """

    def __init__(self, scene: Scene = BALANCE.scene, dt: float = 0.001, spec: RobotSpec | None = None):
        self.spec = spec = carrying(panda() if spec is None else spec, scene)
        self._dof = spec.dof
        self.dt = dt
        self.client = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0, 0, -GRAVITY, self.client)
        pybullet.setTimeStep(dt, self.client)
        self._load_arm()
        self._find_links()
        self._add_ball(scene.ball, scene.home)
        for index, q in zip(self._joints, spec.home, strict=True):
            pybullet.resetJointState(self.arm, index, q, 0.0, physicsClientId=self.client)
        self._holding_effort = self._gravity_torque()
        self._home = pybullet.saveState(self.client)
        self.effort = self._holding_effort
        """The torque applied in the last tick, (n,), N m; after a reset the one that holds the arm."""
        self._brakes = False
        self._push: np.ndarray | None = None
        self.reset(np.array(scene.home))

    def _load_arm(self) -> None:
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_IGNORE_VISUAL_SHAPES
        if self.spec.tool_link is None:
            self.arm = pybullet.loadURDF(
                str(self.spec.urdf), useFixedBase=True, flags=flags, physicsClientId=self.client)
            return
        # PyBullet reads files only, and insists on finding the meshes that it then ignores.
        robot = ElementTree.fromstring(self.spec.description)
        for link in robot.findall('link'):
            for visual in link.findall('visual'):
                link.remove(visual)
        pybullet.setAdditionalSearchPath(str(self.spec.urdf.parent), self.client)
        with NamedTemporaryFile(suffix='.urdf') as file:
            ElementTree.ElementTree(robot).write(file)
            file.flush()
            self.arm = pybullet.loadURDF(file.name, useFixedBase=True, flags=flags, physicsClientId=self.client)

    def _find_links(self) -> None:
        count = pybullet.getNumJoints(self.arm, physicsClientId=self.client)
        info = [pybullet.getJointInfo(self.arm, i, physicsClientId=self.client) for i in range(count)]
        index = {record[1].decode(): record[0] for record in info}
        self._joints = [index[name] for name in self.spec.joints]
        self.tray = next(record[0] for record in info if record[12].decode() == self.spec.tool_frame)
        for link in range(-1, count):
            pybullet.changeDynamics(
                self.arm, link, linearDamping=0, angularDamping=0, jointDamping=0, physicsClientId=self.client)
        self._release_brakes()

    def _add_ball(self, ball: Ball, home: tuple[float, float, float]) -> None:
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_SPHERE, radius=ball.radius, physicsClientId=self.client)
        self.ball = pybullet.createMultiBody(
            ball.mass, shape, -1, list(home), physicsClientId=self.client)
        pybullet.changeDynamics(
            self.ball, -1, lateralFriction=ball.friction, rollingFriction=0, spinningFriction=0, restitution=0,
            linearDamping=0, angularDamping=0, physicsClientId=self.client)
        pybullet.changeDynamics(
            self.arm, self.tray, lateralFriction=1.0, restitution=0, physicsClientId=self.client)

    def _gravity_torque(self) -> np.ndarray:
        still = [0.0] * self._dof
        return np.array(pybullet.calculateInverseDynamics(
            self.arm, list(self.spec.home), still, still, physicsClientId=self.client))

    def reset(self, ball: np.ndarray) -> None:
        """Arm at rest at the reference joints, ball at rest at ``ball`` ((3,), m, base frame)."""
        pybullet.restoreState(self._home, physicsClientId=self.client)
        pybullet.resetBasePositionAndOrientation(
            self.ball, ball.tolist(), [0, 0, 0, 1], physicsClientId=self.client)
        if self._brakes:
            self._release_brakes()
        self._push = None
        self.effort = self._holding_effort

    def joint_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Joint positions, rad, and velocities, rad/s, each (n,)."""
        states = pybullet.getJointStates(self.arm, self._joints, self.client)
        # Half the time of np.array([state[0] for state in states]).
        count = self._dof
        return np.fromiter(map(_POSITION, states), float, count), np.fromiter(map(_VELOCITY, states), float, count)

    def ball_state(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """The ball in the base frame: position, m; quaternion x y z w; velocity, m/s; angular velocity, rad/s."""
        position, orientation = pybullet.getBasePositionAndOrientation(self.ball, physicsClientId=self.client)
        velocity, spin = pybullet.getBaseVelocity(self.ball, physicsClientId=self.client)
        return position, orientation, velocity, spin

    def push(self, force: np.ndarray) -> None:
        """From the next tick on push the tray's origin with ``force`` ((3,), N, base axes), until told otherwise."""
        self._push = force if force.any() else None

    def step(self, torque: np.ndarray) -> None:
        """One tick with joint torques ``torque`` ((n,), N m), which are within the joints' limits."""
        if self._brakes:
            self._release_brakes()
        self.effort = torque
        pybullet.setJointMotorControlArray(
            self.arm, self._joints, pybullet.TORQUE_CONTROL, forces=self.effort.tolist(), physicsClientId=self.client)
        self._advance()

    def step_braked(self) -> None:
        """One tick without a command: the joints' brakes hold them, as a Panda's do when its control stops."""
        if not self._brakes:
            pybullet.setJointMotorControlArray(
                self.arm, self._joints, pybullet.VELOCITY_CONTROL, targetVelocities=[0.0] * self._dof,
                forces=list(self.spec.torque_max), physicsClientId=self.client)
            self._brakes = True
            self.effort = self._holding_effort
        self._advance()

    def _release_brakes(self) -> None:
        # A motor that holds with little force beside the torques is what the engine has for Coulomb friction.
        pybullet.setJointMotorControlArray(
            self.arm, self._joints, pybullet.VELOCITY_CONTROL, forces=[self.spec.joint_friction] * self._dof,
            physicsClientId=self.client)
        self._brakes = False

    def _advance(self) -> None:
        if self._push is not None:
            origin = pybullet.getLinkState(self.arm, self.tray, physicsClientId=self.client)[4]
            pybullet.applyExternalForce(
                self.arm, self.tray, self._push, origin, pybullet.WORLD_FRAME, physicsClientId=self.client)
        pybullet.stepSimulation(self.client)

    def close(self) -> None:
        """See :class:`World`."""
        client, self.client = self.client, _CLOSED  # the engine gives its number to the next world
        if client != _CLOSED and pybullet.isConnected(client):
            pybullet.disconnect(client)
