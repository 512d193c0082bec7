"""What happened in one episode, as the learner needs it."""

from dataclasses import dataclass, field

import numpy as np


@dataclass(eq=False)
class Episode:
    """The steps of an episode. The agent's action, the human's moment and the applied moment are kept apart."""

    observations: list[np.ndarray] = field(default_factory=list)
    """Of each step, (3,), float32"""
    actions: list[np.ndarray] = field(default_factory=list)
    """As drawn, not clipped; of each step, (1,), float32"""
    rewards: list[float] = field(default_factory=list)
    """As the learner sees them, scaled."""
    m_y_human: list[float] = field(default_factory=list)
    """M_yh of each step, N m"""
    m_y_applied: list[float] = field(default_factory=list)
    """M_y of each step, N m"""
    last_observation: np.ndarray | None = None
    """Of the state after the last step."""
    terminated: bool = False
    """The ball fell; False when time was up."""

    def __len__(self) -> int:
        return len(self.rewards)

    def add(self, observation: np.ndarray, action: np.ndarray, reward: float, m_y_human: float, m_y_applied: float,
            ) -> None:
        """One step: what was seen, what was done, and what came of it."""
        self.observations.append(observation)
        self.actions.append(action)
        self.rewards.append(reward)
        self.m_y_human.append(m_y_human)
        self.m_y_applied.append(m_y_applied)
