"""Computed torque holds the UR5 at home for a second, while a moment turns its tool."""

import numpy as np
import pinocchio as pin
from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import load_robot

DT = 0.001
MOMENT = np.array([5.0])
"""M_y at the tool, N m"""

robot = load_robot('ur5')
model = RobotModel(robot)
controller = ComputedTorqueController(model, dt=DT)
data = model.pin_model.createData()
q, qd, torque = robot.home, np.zeros(robot.dof), model.gravity(robot.home).copy()
for _ in range(round(1.0 / DT)):
    torque = controller.torque(q, qd, torque, MOMENT)
    qd = qd + DT * pin.aba(model.pin_model, data, q, qd, torque)
    q = q + DT * qd
print(f'{robot.name}: {np.abs(q - robot.home).max():.4f} rad off, {np.abs(qd).max():.4f} rad/s')
