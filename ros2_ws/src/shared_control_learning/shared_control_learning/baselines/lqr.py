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

"""The linear-quadratic regulator of a known model."""

import numpy as np
from scipy.linalg import solve_discrete_are
from scipy.signal import cont2discrete
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import GRAVITY, RobotModel, pitch
from shared_control.robot.spec_file import panda
from shared_control.robot.tray import carrying
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.teaching.tutor import BALL_ACCELERATION

from .linear import LinearLearner
from .needs import scales_of
from .presets import LqrSettings

M_Y = BALANCE.axes[0]


class KnownLqr(LinearLearner):
    """The regulator of what the data sheets say: the URDF, the controller's gains, and a ball that rolls.

    The state is what is observed of ``balance``: position error e, velocity v, pitch p.

        e' = -v,    v' = 5/7 g p,    p' = (c (M - M_level) - p) / T

    The arm under its PD answers a moment with the compliance ``c = j K_p^-1 j^T`` (j: the row of the tray's Jacobian
    for turns about y at the reference posture), and on average ``T = j K_p^-1 K_d K_p^-1 j^T / c`` later: the first two
    moments of its step response, whatever its masses. ``M_level`` undoes the pitch of the tray in that posture, and
    how far the ball's weight bends it. Source: B. Anderson and J. Moore, Optimal Control: Linear Quadratic Methods,
    1990; weights by Bryson's rule. It learns nothing.

    Raises:
        ValueError: the task is not ``balance``.
    """

    settings: LqrSettings

    def __init__(self, name: str, task: Task, settings: LqrSettings, seed: int = 0):
        super().__init__(name, task, settings, seed)
        scales = scales_of(name, task)
        compliance, seconds, level = tilting(task)
        a = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, BALL_ACCELERATION], [0.0, 0.0, -1.0 / seconds]])
        b = np.array([[0.0], [0.0], [compliance / seconds]])
        a, b, *_ = cont2discrete((a, b, np.eye(3), np.zeros((3, 1))), POLICY_PERIOD)
        gain = regulator(a, b, np.diag([settings.error ** -2, settings.velocity ** -2, 0.0]),
                         np.array([[settings.moment ** -2]]))
        self.weights = -gain * scales / task.scale
        self.bias = np.array([level]) / task.scale


def tilting(task: Task) -> tuple[float, float, float]:
    """How the Panda tilts the tray: compliance, rad/(N m); delay, s; the moment that levels the tray, N m."""
    spec = carrying(panda(), task.scene)
    model, home = RobotModel(spec), np.array(spec.home)
    turns = model.jacobian(home)[[2, M_Y]]
    kp, kd = spec.gains['task'].kp, spec.gains['task'].kd
    compliance = turns[1] / kp @ turns[1]
    seconds = turns[1] / kp * kd / kp @ turns[1] / compliance
    weight = -task.scene.ball.mass * GRAVITY
    leaning = pitch(model.tray_pose(home)[1]) + weight * (turns[1] / kp @ turns[0])
    return float(compliance), float(seconds), float(-leaning / compliance)


def regulator(a: np.ndarray, b: np.ndarray, weights: np.ndarray, costs: np.ndarray) -> np.ndarray:
    """G of ``u = -G x``, (k, n), with the least sum of ``x weights x + u costs u`` along ``x' = a x + b u``.

    Raises:
        numpy.linalg.LinAlgError: nothing stabilises it.
    """
    value = solve_discrete_are(a, b, weights, costs)
    return np.linalg.solve(costs + b.T @ value @ b, b.T @ value @ a)
