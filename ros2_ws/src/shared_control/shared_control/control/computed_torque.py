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

"""Computed-torque control with an implicit PD."""

import numpy as np
import pinocchio as pin

from ..not_copied import NotCopied
from ..robot.model import RobotModel
from ..robot.spec import RobotSpec

_WORLD = pin.Convention.WORLD
"""Looked up once: it takes as long as one of the small sums below."""
M_Y: tuple[int, ...] = (4,)
"""The row of the wrench that the thesis shares: ``W_tr = [0 0 0 0 M_y 0]``."""


class ComputedTorqueController(NotCopied):
    """``tau_cmd = tau_pd + J^T W_tr + tau_g`` (39, 40), limited.

    An explicit PD (27) is unstable on the Panda: ``M^-1 K_d dt`` has eigenvalues up to 3.6 for the task gains at
    1 kHz, 72 for the high gains of Table 3 (stable below 2). RaiSim, which the thesis ran on, integrates its PD
    implicitly, and so does this (stable PD, Tan, Liu and Turk, 2011): with the horizon h = dt,

        ``tau_pd = K_p (q_ref - q - qd h) + K_d (qd_ref - qd - a h)``,

    where a is the acceleration that tau_cmd itself causes, ``tau_cmd = M a + C qd + G`` (15). So a solves

        ``(M + K_d h) a = K_p (q_ref - q - qd h) + K_d (qd_ref - qd) + J^T W + tau_g - C qd - G``.

    ``K_d h`` enters as rotor inertia would, so M + K_d h is the mass matrix of a model with that inertia, and RNEA
    gives tau_cmd from a. When tau_g is added, the last three terms cancel.

    A torque that reaches a free-running robot n ticks late is stable only while ``K_d h (M + K_d h)^-1 dt / h`` has
    eigenvalues below 2 sin(pi / (4 n + 2)): 1 for one tick, 0.62 for two, 0.28 for five. They are below dt / h, so a
    longer horizon buys that at the price of damping: h = 4 ms holds up to five ticks of delay.

    The controller keeps nothing from tick to tick: the torque's rate is limited against what the robot reports.

    Args:
        model: the robot.
        axes: rows of the wrench at the tool (fx, fy, fz, mx, my, mz) that the moments act along, (k,).
        gains: name of the PD gains, of those that the robot has.
        dt: period of the control loop, s.
        horizon: h, s; dt when not given.
        q_reference: joint positions to hold, (n,), rad; the robot's home when not given.
        compensate_nonlinear: add tau_g (28, 29); off only to show what it is good for.
        robot_compensates_gravity: the robot adds G(q) itself, as franka's driver does: leave it out of the command
            and out of the prediction. C(q, qd) qd stays, as in libfranka's own examples.
    """

    def __init__(self, model: RobotModel, axes: tuple[int, ...] = M_Y, gains: str = 'task',
                 dt: float = 0.001, horizon: float | None = None, q_reference: np.ndarray | None = None,
                 compensate_nonlinear: bool = True,
                 robot_compensates_gravity: bool = False):
        self._model = model
        self._spec = spec = model.spec
        kp, kd = spec.gains[gains].kp, spec.gains[gains].kd
        self._horizon = dt if horizon is None else horizon
        self._implicit = pin.Model(model.pin_model)
        self._implicit.armature = kd * self._horizon
        self._implicit_data = self._implicit.createData()
        # Views, and which part of the moment acts along each: numpy is twice as fast with an array as with a number.
        self._jacobian_rows = [(self._implicit_data.J[row], slice(i, i + 1)) for i, row in enumerate(axes)]
        self._no_moment = np.zeros(len(axes))
        self._kp = kp
        self._kd = kd
        self._damping = kp * self._horizon + kd
        self._rate = np.full(spec.dof, spec.torque_rate_max * dt)
        self._q_reference = spec.home if q_reference is None else q_reference
        self._compensate = compensate_nonlinear
        self._robot_compensates_gravity = robot_compensates_gravity

    def torque(self, q: np.ndarray, qd: np.ndarray, effort: np.ndarray, moment: np.ndarray,
               q_reference: np.ndarray | None = None, qd_reference: np.ndarray | None = None) -> np.ndarray:
        """The torque to command, (n,), N m.

        Args:
            q: joint positions, (n,), rad.
            qd: joint velocities, (n,), rad/s.
            effort: the torque that the robot was last commanded, (n,), N m.
            moment: at the tray along the controller's axes, (k,), N m.
            q_reference: where to be at the end of the tick, rad; the constructor's when not given.
            qd_reference: how fast, rad/s; at rest when not given.

        Raises:
            ValueError: the moment has another number of axes.
        """
        if len(moment) != len(self._jacobian_rows):
            raise ValueError(f'a moment of {len(moment)} numbers for {len(self._jacobian_rows)} axes')
        q_reference = self._q_reference if q_reference is None else q_reference
        # M + K_d h. This also fills in the Jacobian in the base frame; a moment acts alike on all of the tray's points.
        pin.crba(self._implicit, self._implicit_data, q, _WORLD)
        pin.cholesky.decompose(self._implicit, self._implicit_data)
        wanted = self._kp * (q_reference - q)
        wanted -= self._damping * qd
        for row, component in self._jacobian_rows:
            wanted += row * moment[component]
        if qd_reference is not None:
            wanted += self._kd * qd_reference
        if not self._compensate:
            wanted -= self._model.nonlinear_effects(q, qd)
        acceleration = pin.cholesky.solve(self._implicit, self._implicit_data, wanted)
        torque = self._model.inverse_dynamics(q, qd, acceleration)
        if self._robot_compensates_gravity:
            torque -= self._model.gravity(q)
        return limit_torque(self._spec, torque, effort, self._rate)

    def damping_torque(self, q: np.ndarray, qd: np.ndarray, effort: np.ndarray) -> np.ndarray:
        """The torque that brings the arm to rest wherever it is, (n,), N m: K_d alone, with what compensates weight."""
        return self.torque(q, qd, effort, self._no_moment, q_reference=q + qd * self._horizon)


def limit_torque(spec: RobotSpec, torque: np.ndarray, previous: np.ndarray, step: np.ndarray | float) -> np.ndarray:
    """``torque`` kept within the joints' limits and within ``step`` (N m) of ``previous``; (n,), N m."""
    limited, upper = previous - step, previous + step
    np.maximum(torque, limited, out=limited)
    return spec.clamp_torque(np.minimum(limited, upper, out=limited))
