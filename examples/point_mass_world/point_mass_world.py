"""A world without a physics engine: the arm by pinocchio, the ball as a point that rolls on the tray."""

import numpy as np
import pinocchio as pin
from shared_control import RobotModel, RobotSpec, Scene
from shared_control.robot.model import GRAVITY

ROLLING = 5.0 / 7.0
"""The part of a pull that moves a solid ball which rolls without slipping; the rest turns it."""
PULL = np.array([0.0, 0.0, -GRAVITY])


class PointMassWorld:
    """A :class:`shared_control.World`. The tray has no walls, and its ball neither bounces nor weighs on the arm.

    Args:
        scene: the tray and the ball.
        dt: length of a tick, s.
        robot: the arm.
    """

    def __init__(self, scene: Scene, dt: float, robot: RobotSpec):
        self.dt, self.spec = dt, robot
        self._edge = np.array([scene.half_length, scene.half_width])
        self._height = scene.surface + scene.ball.radius
        self._model = RobotModel(robot)
        self._data = self._model.pin_model.createData()
        self._holding = self._model.gravity(robot.home).copy()
        self.reset(np.array(scene.home))

    def reset(self, ball: np.ndarray) -> None:
        """See World."""
        self.effort = self._holding
        self._q, self._qd = self.spec.home.copy(), np.zeros(self.spec.dof)
        self._tray_velocity = np.zeros(3)
        self._push = np.zeros(3)
        self._ball, self._ball_velocity = ball.astype(float), np.zeros(3)
        self._on_tray = False
        self._place, self._rolling = np.zeros(2), np.zeros(2)  # along the tray's sides, m and m/s, while it is on it

    def joint_state(self) -> tuple[np.ndarray, np.ndarray]:
        """See World."""
        return self._q.copy(), self._qd.copy()

    def ball_state(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """See World: a point does not turn."""
        position, velocity = tuple(self._ball.tolist()), tuple(self._ball_velocity.tolist())
        return position, (0.0, 0.0, 0.0, 1.0), velocity, (0.0, 0.0, 0.0)

    def push(self, force: np.ndarray) -> None:
        """See World."""
        self._push = force

    def step(self, torque: np.ndarray) -> None:
        """See World: semi-implicit Euler."""
        self.effort = torque
        pushed = torque + self._model.jacobian(self._q)[:3].T @ self._push
        acceleration = pin.aba(self._model.pin_model, self._data, self._q, self._qd, pushed)
        self._qd = self._qd + acceleration * self.dt
        self._q = self._q + self._qd * self.dt
        self._move_ball()

    def step_braked(self) -> None:
        """See World."""
        self.effort = self._holding
        self._qd = np.zeros(self.spec.dof)
        self._move_ball()

    def _move_ball(self) -> None:
        before = self._tray_velocity
        velocity = self._tray_velocity = self._model.jacobian(self._q)[:3] @ self._qd
        tray, rotation = (part.copy() for part in self._model.tray_pose(self._q))
        if not self._on_tray:
            self._ball_velocity = self._ball_velocity + PULL * self.dt
            self._ball = self._ball + self._ball_velocity * self.dt
            x, y, height = rotation.T @ (self._ball - tray)
            if 0.0 < height <= self._height and self._is_over_tray(np.array([x, y])):
                self._on_tray = True
                self._place, self._rolling = np.array([x, y]), (rotation.T @ (self._ball_velocity - velocity))[:2]
            return
        # In the tray's frame the ball is pulled by gravity and by what the tray's own acceleration leaves behind.
        pull = rotation.T @ (PULL - (velocity - before) / self.dt)
        self._rolling = self._rolling + ROLLING * pull[:2] * self.dt
        self._place = self._place + self._rolling * self.dt
        self._ball = tray + rotation @ np.append(self._place, self._height)
        self._ball_velocity = velocity + rotation @ np.append(self._rolling, 0.0)
        self._on_tray = self._is_over_tray(self._place)

    def _is_over_tray(self, place: np.ndarray) -> bool:
        return bool((np.abs(place) <= self._edge).all())

    def close(self) -> None:
        """See World: there is nothing to free."""
