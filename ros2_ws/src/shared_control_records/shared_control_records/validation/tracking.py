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

"""The tracking test (2.4, Figs. 3-11): the tray is to move along x as a cosine in velocity."""

from dataclasses import dataclass

import numpy as np
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.control.references import JointReference, cosine_velocity
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import RobotModel, manipulability
from shared_control.world import World

SECONDS = 8.0
"""Length of a run, s: two periods of the slowest reference. The thesis does not say."""
SETTLING_SECONDS = 2.0
"""The arm starts at rest and the reference at full speed: this long the start counts as such, s."""
GAIN_SETS = ('high', 'low')
"""Table 3"""
_BESIDE_THE_TRAY = (5.0, 0.0, 0.94)
"""Where the ball is dropped, so that the arm is alone, m."""
_NO_MOMENT = np.zeros(1)


@dataclass(frozen=True, eq=False)
class Tracking:
    """One run, a sample a tick."""

    gains: str
    """``high`` or ``low``"""
    nonlinear_terms: bool
    """Scenario 1 of the thesis: tau_g is added (29). False: scenario 2."""
    frequency: float
    """Hz"""
    seconds: np.ndarray
    """(ticks,), s"""
    reference: np.ndarray
    """Reference of the tray's velocity along x (25), (ticks,), m/s"""
    measured: np.ndarray
    """The tray's velocity along x, (ticks,), m/s"""
    distance: np.ndarray
    """Distance of the tray from where the reference has it, (ticks,), m"""
    manipulability: np.ndarray
    """k_w (34), (ticks,)"""

    @property
    def rms(self) -> float:
        """RMS error of the velocity, m/s."""
        return _rms(self.measured - self.reference)

    @property
    def rms_settled(self) -> float:
        """The same without the start, m/s."""
        return _rms((self.measured - self.reference)[self.seconds >= SETTLING_SECONDS])


def track(model: RobotModel, world: World, gains: str, nonlinear_terms: bool, frequency: float,
          reference: JointReference) -> Tracking:
    """Let the arm follow ``reference``, made for ``frequency`` (Hz)."""
    controller = ComputedTorqueController(
        model, gains=gains, dt=CONTROL_PERIOD, compensate_nonlinear=nonlinear_terms)
    world.reset(np.array(_BESIDE_THE_TRAY))
    samples = []
    for q_reference, qd_reference in zip(reference.q, reference.qd, strict=True):
        q, qd = world.joint_state()
        world.step(controller.torque(q, qd, world.effort, _NO_MOMENT, q_reference, qd_reference))
        q, qd = world.joint_state()
        jacobian = model.jacobian(q)
        off = model.tray_pose(q)[0].copy()
        off -= model.tray_pose(q_reference)[0]
        samples.append((jacobian[0] @ qd, np.linalg.norm(off), manipulability(jacobian)))
    measured, distance, k_w = np.array(samples).T
    seconds = np.arange(1, len(samples) + 1) * CONTROL_PERIOD
    return Tracking(
        gains, nonlinear_terms, frequency, seconds, cosine_velocity(seconds, frequency), measured, distance, k_w)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values ** 2)))
