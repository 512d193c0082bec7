"""The plant in this process: the same controller and world that the nodes run."""

from typing import Protocol

from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.control.moments import sum_moments
from shared_control.plant import PlantState
from shared_control.rates import CONTROL_PERIOD, TICKS_PER_ACTION
from shared_control.robot.model import PandaModel
from shared_control.tasks.balance.scene import Ball
from shared_control.tasks.balance.task import BALL_START_RANGE, BallStarts

from .bullet import BallOnTrayWorld


class Person(Protocol):
    """Whoever holds the keys: a simulated tutor, or a script."""

    def reset(self, seed: int | None) -> None:
        """A new episode begins."""

    def moment(self, state: PlantState) -> float:
        """M_yh for the coming period, N m, by someone who sees ``state``."""


class LocalPlant:
    """World, controller and (if there is one) a person, stepped in a loop.

    Args:
        person: who presses keys; nobody when None.
        moment_limit: bound of |M_y|, N m.
        ball: the ball.
        ball_start_range: where it is dropped, x in the base frame, m.
    """

    def __init__(self, person: Person | None = None, moment_limit: float = 20.0, ball: Ball = Ball(),
                 ball_start_range: tuple[float, float] = BALL_START_RANGE):
        self.world = BallOnTrayWorld(ball, CONTROL_PERIOD)
        self.controller = ComputedTorqueController(PandaModel(), dt=CONTROL_PERIOD)
        self._person = person
        self._limit = moment_limit
        self._starts = BallStarts(start_range=ball_start_range)
        self._state: PlantState | None = None

    def reset(self, seed: int | None = None) -> PlantState:
        """See :meth:`Plant.reset`."""
        if seed is not None:
            self._starts.seed(seed)
        self.world.reset(self._starts.next())
        if self._person is not None:
            self._person.reset(seed)
        self._state = self._read(0.0, 0.0)
        return self._state

    def advance(self, m_y_agent: float) -> PlantState:
        """See :meth:`Plant.advance`."""
        assert self._state is not None, 'reset the plant first'
        m_y_human = 0.0 if self._person is None else self._person.moment(self._state)
        m_y = sum_moments(m_y_agent, m_y_human, self._limit)
        for _ in range(TICKS_PER_ACTION):
            self.tick(m_y)
        self._state = self._read(m_y_human, m_y)
        return self._state

    def tick(self, m_y: float) -> None:
        """One tick of controller and physics with the moment ``m_y``, N m."""
        q, qd = self.world.joint_state()
        self.world.step(self.controller.torque(q, qd, self.world.effort, m_y))

    def _read(self, m_y_human: float, m_y_applied: float) -> PlantState:
        position, _, velocity, _ = self.world.ball_state()
        return PlantState(self.world.joint_state()[0], position, velocity, m_y_human, m_y_applied)

    def close(self) -> None:
        """See :meth:`Plant.close`."""
        self.world.close()
