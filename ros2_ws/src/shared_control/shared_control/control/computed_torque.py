"""Computed-torque control with an implicit PD."""

import numpy as np
import pinocchio as pin

from ..robot.limits import TORQUE_MAX, TORQUE_RATE_MAX
from ..robot.model import PandaModel
from ..robot.posture import GAINS, Q_REFERENCE, Gains

WRENCH_ROW = 4
"""Row of the Jacobian that belongs to M_y in ``W_tr = [0 0 0 0 M_y 0]``."""


class ComputedTorqueController:
    """``tau_cmd = tau_pd + J^T W_tr + tau_g`` (39, 40), limited.

    An explicit PD (27) is unstable on this arm: ``M^-1 K_d dt`` has eigenvalues up to 3.6 for the task gains at
    1 kHz, 72 for the high gains of Table 3 (stable below 2). RaiSim, which the thesis ran on, integrates its PD
    implicitly, and so does this (stable PD, Tan, Liu and Turk, 2011): the acceleration a at the end of the tick solves

        ``(M + K_d h) a = K_p (q_ref - q - qd h) + K_d (qd_ref - qd) + J^T W + tau_g - C qd - G``

    and ``tau_pd = K_p (q_ref - q - qd h) + K_d (qd_ref - qd - a h)``, with the horizon h = dt. ``K_d h`` enters the
    equation as rotor inertia would, so the articulated-body algorithm of a model with that inertia solves it.

    A torque that reaches a free-running robot n ticks late is stable only while ``K_d h (M + K_d h)^-1 dt / h`` has
    eigenvalues below 2 sin(pi / (4 n + 2)): 1 for one tick, 0.62 for two, 0.28 for five. They are below dt / h, so a
    longer horizon buys that at the price of damping: h = 4 ms holds up to five ticks of delay.

    The controller keeps nothing from tick to tick: the torque's rate is limited against what the robot reports.

    Args:
        model: the robot.
        gains: PD gains.
        dt: period of the control loop, s.
        horizon: h, s; dt when not given.
        q_reference: joint positions to hold, (7,), rad.
        compensate_nonlinear: add tau_g (28, 29); off only to show what it is good for.
        robot_compensates_gravity: the robot adds G(q) itself, as franka's driver does: leave it out of the command
            and out of the prediction. C(q, qd) qd stays, as in libfranka's own examples.
    """

    def __init__(self, model: PandaModel, gains: Gains = GAINS['task'], dt: float = 0.001,
                 horizon: float | None = None, q_reference: np.ndarray = Q_REFERENCE, compensate_nonlinear: bool = True,
                 robot_compensates_gravity: bool = False):
        self._model = model
        self._implicit = pin.Model(model.pin_model)
        self._horizon = dt if horizon is None else horizon
        self._implicit.armature = gains.kd * self._horizon
        self._implicit_data = self._implicit.createData()
        self._kp = gains.kp
        self._kd = gains.kd
        self._damping = gains.kp * self._horizon + gains.kd
        self._kd_horizon = gains.kd * self._horizon
        self._rate = TORQUE_RATE_MAX * dt
        self._q_reference = q_reference
        self._compensate = compensate_nonlinear
        self._robot_compensates_gravity = robot_compensates_gravity

    def torque(self, q: np.ndarray, qd: np.ndarray, effort: np.ndarray, m_y: float,
               q_reference: np.ndarray | None = None, qd_reference: np.ndarray | None = None) -> np.ndarray:
        """The torque to command, (7,), N m.

        Args:
            q: joint positions, (7,), rad.
            qd: joint velocities, (7,), rad/s.
            effort: the torque that the robot was last commanded, (7,), N m.
            m_y: moment about base y at the tray, N m.
            q_reference: where to be at the end of the tick, rad; the constructor's when not given.
            qd_reference: how fast, rad/s; at rest when not given.
        """
        q_reference = self._q_reference if q_reference is None else q_reference
        nonlinear = self._model.nonlinear_effects(q, qd)
        feedforward = self._model.jacobian(q)[WRENCH_ROW] * m_y
        if self._compensate:
            feedforward += nonlinear
        # K_p (q_ref - q - qd h) + K_d (qd_ref - qd), with as few operations as it takes.
        explicit = self._kp * (q_reference - q) - self._damping * qd
        if qd_reference is not None:
            explicit += self._kd * qd_reference
        acceleration = pin.aba(self._implicit, self._implicit_data, q, qd, explicit + feedforward)
        torque = explicit - self._kd_horizon * acceleration + feedforward
        if self._robot_compensates_gravity:
            torque -= self._model.gravity(q)
        return limit_torque(torque, effort, self._rate)


def limit_torque(torque: np.ndarray, previous: np.ndarray, step: float) -> np.ndarray:
    """``torque`` kept within the joints' limits and within ``step`` (N m) of ``previous``; (7,), N m."""
    # np.minimum and np.maximum take a quarter of np.clip's time on seven numbers.
    torque = np.minimum(np.maximum(torque, previous - step), previous + step)
    return np.minimum(np.maximum(torque, -TORQUE_MAX), TORQUE_MAX)
