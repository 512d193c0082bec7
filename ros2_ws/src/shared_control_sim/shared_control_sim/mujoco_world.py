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

"""MuJoCo: the same arm, tray and ball as in PyBullet, from the same description."""

from xml.etree import ElementTree

import mujoco
import numpy as np
from shared_control.not_copied import NotCopied
from shared_control.robot.model import GRAVITY
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying
from shared_control.scene import Ball, Scene
from shared_control.tasks.balance import BALANCE

_AS_IT_STANDS = {
    'inertiafromgeom': 'false', 'balanceinertia': 'false', 'boundmass': '0', 'boundinertia': '0',
    'fusestatic': 'false', 'strippath': 'false'}
"""Options of MuJoCo's compiler: masses and inertias are the description's own, and the tool stays a body."""
_CONTACT = {'solref': (0.004, 1.0), 'solimp': (0.95, 0.99, 0.001, 0.5, 2.0)}
"""How stiffly the ball touches: time constant (s) and damping ratio, impedance. With the engine's defaults it lies
0.4 mm deep and bounces; with these its height is PyBullet's within a micrometre."""
_BRAKE = {'solref': (0.002, 1.0), 'solimp': (0.9999, 0.9999, 0.001, 0.5, 2.0)}
"""How stiff the friction of the joints is: with the defaults braked joints creep by 0.08 rad in a second, with these by
1e-5 rad."""


class MujocoWorld(NotCopied):
    """An arm that takes joint torques, with a ball on its tray.

    An episode depends on nothing that came before it, since :meth:`reset` puts back all that a step depends on. Two
    worlds given the same torques from the same start go through the same states, bit for bit.

    Args:
        scene: the tray and the ball.
        dt: length of a tick, s.
        spec: the robot; the Panda when not given.
    """

    def __init__(self, scene: Scene = BALANCE.scene, dt: float = 0.001, spec: RobotSpec | None = None):
        self.spec = spec = carrying(panda() if spec is None else spec, scene)
        self.dt = dt
        self._home = np.array(scene.home)
        self.model = _model(spec, scene.ball, dt)
        self.data = mujoco.MjData(self.model)
        n = spec.dof
        # Views of the engine's own arrays: the arm's n numbers come first, then those of the ball.
        self._q, self._qd = self.data.qpos[:n], self.data.qvel[:n]
        self._place, self._quaternion = self.data.qpos[n:n + 3], self.data.qpos[n + 3:]
        self._velocity, self._own_spin = self.data.qvel[n:n + 3], self.data.qvel[n + 3:]
        self._applied, self._friction = self.data.qfrc_applied[:n], self.model.dof_frictionloss[:n]
        self._friction[:] = spec.joint_friction
        self._tool = self.model.body(spec.tool_frame).id
        self._q[:] = spec.home
        mujoco.mj_forward(self.model, self.data)
        self._holding_effort = self.data.qfrc_bias[:n].copy()
        self.effort = self._holding_effort
        """The torque applied in the last tick, (n,), N m; after a reset the one that holds the arm."""
        self._brakes = False
        self._push: np.ndarray | None = None
        self.reset(self._home)

    def reset(self, ball: np.ndarray) -> None:
        """Arm at rest at the reference joints, ball at rest at ``ball`` ((3,), m, base frame)."""
        mujoco.mj_resetData(self.model, self.data)
        self._q[:] = self.spec.home
        self._place[:] = ball
        if self._brakes:
            self._release_brakes()
        self._push = None
        self.effort = self._holding_effort

    def joint_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Joint positions, rad, and velocities, rad/s, each (n,)."""
        return self._q.copy(), self._qd.copy()

    def ball_state(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """The ball in the base frame: position, m; quaternion x y z w; velocity, m/s; angular velocity, rad/s."""
        w, *xyz = self._quaternion.tolist()
        spin = np.empty(3)
        mujoco.mju_rotVecQuat(spin, self._own_spin, self._quaternion)  # the engine keeps it in the ball's own axes
        return tuple(self._place.tolist()), (*xyz, w), tuple(self._velocity.tolist()), tuple(spin.tolist())

    def push(self, force: np.ndarray) -> None:
        """From the next tick on push the tray's origin with ``force`` ((3,), N, base axes), until told otherwise."""
        self._push = force if force.any() else None
        if self._push is None:
            self.data.xfrc_applied[self._tool] = 0.0

    def step(self, torque: np.ndarray) -> None:
        """One tick with joint torques ``torque`` ((n,), N m), which are within the joints' limits."""
        if self._brakes:
            self._release_brakes()
        self._applied[:] = self.effort = torque
        self._advance()

    def step_braked(self) -> None:
        """One tick without a command: the joints' brakes hold them, as a Panda's do when its control stops."""
        if not self._brakes:
            self._friction[:] = self.spec.torque_max
            self._applied[:] = 0.0
            self._brakes = True
            self.effort = self._holding_effort
        self._advance()

    def _release_brakes(self) -> None:
        self._friction[:] = self.spec.joint_friction
        self._brakes = False

    def _advance(self) -> None:
        if self._push is not None:
            # The engine wants the force at the centre of mass; where that is, it knows of the tick before only.
            mujoco.mj_kinematics(self.model, self.data)
            lever = self.data.xpos[self._tool] - self.data.xipos[self._tool]
            self.data.xfrc_applied[self._tool] = [*self._push, *np.cross(lever, self._push)]
        mujoco.mj_step(self.model, self.data)

    def close(self) -> None:
        """See :class:`World`: nothing to free, the engine has no server."""


def _model(spec: RobotSpec, ball: Ball, dt: float) -> mujoco.MjModel:
    """The description as the engine reads it, and a ball."""
    robot = ElementTree.fromstring(spec.description)
    for link in robot.findall('link'):
        for visual in link.findall('visual'):
            link.remove(visual)
    options = ElementTree.SubElement(robot, 'mujoco')
    ElementTree.SubElement(options, 'compiler', {**_AS_IT_STANDS, 'meshdir': str(spec.urdf.parent)})
    made = mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding='unicode'))
    made.option.timestep = dt
    made.option.gravity = (0.0, 0.0, -GRAVITY)
    made.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    for geom in made.geoms:
        geom.contype = 0  # the arm does not touch itself, as in PyBullet
    _add_ball(made, ball)
    model = made.compile()
    model.dof_solref[:spec.dof] = _BRAKE['solref']
    model.dof_solimp[:spec.dof] = _BRAKE['solimp']
    return model


def _add_ball(made: mujoco.MjSpec, ball: Ball) -> None:
    """A solid sphere that moves freely and slides at its own coefficient, whatever it touches."""
    inertia = 0.4 * ball.mass * ball.radius ** 2
    body = made.worldbody.add_body(name='ball', mass=ball.mass, inertia=[inertia] * 3, explicitinertial=True)
    body.add_freejoint()
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[ball.radius, 0.0, 0.0], condim=3, friction=[ball.friction, 0.0, 0.0],
        priority=1, **_CONTACT)
