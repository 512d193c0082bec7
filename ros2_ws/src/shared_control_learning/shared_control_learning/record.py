"""The figures of one episode, taught or tested."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from shared_control.rates import POLICY_PERIOD

SETTLED_SECONDS = 3.0
"""The end of an episode, over which a settled ball is judged, s."""

REWARD_TERMS = ('R_alpha', 'R_V', 'R_kw', 'R_P', 'R_Pe', 'fall')


def settled(values: np.ndarray) -> float:
    """Mean magnitude over the last 3 s of a series at the policy's rate."""
    return float(np.abs(values[-round(SETTLED_SECONDS / POLICY_PERIOD):]).mean())


@dataclass(eq=False)
class EpisodeRecord:
    """Collects what ``BalanceEnv.step`` tells, step by step."""

    episode: int
    """From 1."""
    phase: str
    """``teach`` or ``test``"""
    reward_terms: dict[str, float] = field(default_factory=lambda: dict.fromkeys(REWARD_TERMS, 0.0))
    """Sums by name, unscaled."""
    fallen: bool = False
    learn_seconds: float = 0.0
    """Duration of the update after the episode, s."""
    position_error: list[float] = field(default_factory=list)
    """Of each step, m"""
    velocity: list[float] = field(default_factory=list)
    """Of each step, m/s"""
    _m_y_human: list[float] = field(default_factory=list)
    _m_y_agent: list[float] = field(default_factory=list)

    def add(self, info: dict[str, Any]) -> None:
        """One step."""
        for name, value in info['reward_terms'].items():
            self.reward_terms[name] += value
        self.fallen = info['fallen']
        self.position_error.append(info['state'].position_error)
        self.velocity.append(info['state'].ball_velocity)
        self._m_y_human.append(info['m_y_human'])
        self._m_y_agent.append(info['m_y_agent'])

    @property
    def steps(self) -> int:
        """Steps so far."""
        return len(self.velocity)

    @property
    def episode_return(self) -> float:
        """Sum of the reward, unscaled and not discounted."""
        return sum(self.reward_terms.values())

    @property
    def human_share(self) -> float:
        """Mean of |M_yh| / (|M_yh| + |M_yai|), 0..1."""
        human, agent = np.abs(self._m_y_human), np.abs(self._m_y_agent)
        both = human + agent
        return float(np.divide(human, both, out=np.zeros_like(both), where=both > 0.0).mean()) if self.steps else 0.0

    @property
    def intervention_rate(self) -> float:
        """Part of the steps in which the human held a moment, 0..1."""
        return float(np.mean(np.array(self._m_y_human) != 0.0)) if self.steps else 0.0

    def row(self) -> dict[str, float | int | str]:
        """The figures by name, for a table."""
        return {
            'episode': self.episode, 'phase': self.phase, 'steps': self.steps,
            'seconds': round(self.steps * POLICY_PERIOD, 3), 'return': self.episode_return, **self.reward_terms,
            'fallen': int(self.fallen), 'mean_abs_m_y_human': float(np.abs(self._m_y_human).mean()),
            'mean_abs_m_y_agent': float(np.abs(self._m_y_agent).mean()),
            'std_m_y_human': float(np.std(self._m_y_human)), 'std_m_y_agent': float(np.std(self._m_y_agent)),
            'human_share': self.human_share,
            'intervention_rate': self.intervention_rate,
            'settled_position_error': settled(np.array(self.position_error)),
            'settled_velocity': settled(np.array(self.velocity)), 'learn_seconds': self.learn_seconds}
