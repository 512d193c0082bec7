"""What happened in one episode, as the learner needs it."""

from dataclasses import dataclass, field

import numpy as np
import torch
from gymnasium.spaces import Box
from stable_baselines3.common.buffers import RolloutBuffer


@dataclass(frozen=True, eq=False)
class Choice:
    """What the policy chose in one state."""

    observation: np.ndarray
    """(3,), float32"""
    action: np.ndarray
    """As drawn, not clipped; (1,), float32"""
    value: torch.Tensor
    """Of the state, (1,)"""
    log_probability: torch.Tensor
    """Of the action, (1,)"""


@dataclass(eq=False)
class Episode:
    """The steps of an episode. Action, human moment and applied moment are kept apart."""

    choices: list[Choice] = field(default_factory=list)
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

    def add(self, choice: Choice, reward: float, m_y_human: float, m_y_applied: float) -> None:
        """One step."""
        self.choices.append(choice)
        self.rewards.append(reward)
        self.m_y_human.append(m_y_human)
        self.m_y_applied.append(m_y_applied)

    def observations(self) -> np.ndarray:
        """(steps, 3)"""
        return np.array([choice.observation for choice in self.choices])


def rollout_buffer(episode: Episode, last_value: torch.Tensor, observation_space: Box, action_space: Box,
                   gamma: float, gae_lambda: float) -> RolloutBuffer:
    """The episode as Stable-Baselines3's rollout, with advantages; as long as the episode is.

    Args:
        last_value: value of the state after the last step, (1,); counts when the episode was cut off by time.
    """
    buffer = RolloutBuffer(
        len(episode), observation_space, action_space, device='cpu', gamma=gamma, gae_lambda=gae_lambda)
    for step, (choice, reward) in enumerate(zip(episode.choices, episode.rewards, strict=True)):
        buffer.add(choice.observation, choice.action, np.array([reward]), np.array([step == 0]),
                   choice.value, choice.log_probability)
    buffer.compute_returns_and_advantage(last_value, np.array([episode.terminated]))
    return buffer
