"""PPO that a person's corrections teach directly, as well."""

from typing import NamedTuple

import numpy as np
import torch
from stable_baselines3.common.type_aliases import RolloutBufferSamples
from torch.nn.functional import mse_loss

from ..envs.plant import POLICY_PERIOD
from .episode import Episode
from .episode_ppo import EpisodePPO
from .presets import CoachingSettings


class Corrections(NamedTuple):
    """What the person's key presses say about the policy."""

    observations: np.ndarray
    """States that were corrected, (n, 3)"""
    labels: np.ndarray
    """What the policy should have done there, (n, 1)"""


def find_corrections(episode: Episode, means: np.ndarray, coaching: CoachingSettings,
                     action_scale: float) -> Corrections:
    """The corrections of an episode.

    People react late: the moment held at t corrects what the policy did at t - d. Label:
    ``y = clip(pi(s_{t-d}) + g M_yh(t) / M_max)``.

    Args:
        means: what the policy does in the states of the episode without exploring, (steps, 1).
        action_scale: M_max, N m.
    """
    delay = round(coaching.delay / POLICY_PERIOD)
    human = np.array(episode.m_y_human, np.float32)[delay:, None]
    corrected = np.flatnonzero(human)
    observations = np.array(episode.observations)[:len(human)][corrected]
    labels = means[:len(human)] + coaching.gain * human / action_scale
    return Corrections(observations, np.clip(labels, -1.0, 1.0)[corrected])


class CoachedPPO(EpisodePPO):
    """Adds ``lambda |pi(s_{t-d}) - y|^2``, meaned over the corrected states, to the loss of PPO.

    Corrective advice as labels of a network: COACH (Celemin and Ruiz-del-Solar, 2019) and D-COACH (Perez-Dattari et
    al., 2018); beside a reward, as PVP (Peng et al., 2023) does. Without corrections it is PPO, to the bit.
    """

    _corrections: Corrections
    _weight: float

    def learn_from(self, episode: Episode) -> None:
        """One update from a finished episode and from its corrections."""
        coaching = self.preset.coaching
        assert coaching is not None, f'preset {self.preset.name!r} has no coaching settings'
        with torch.no_grad():
            means = self.means(torch.as_tensor(np.array(episode.observations))).clamp(-1.0, 1.0).numpy()
        self._corrections = find_corrections(episode, means, coaching, self.preset.task.action_scale)
        self._weight = coaching.weight_in(self.episode + 1)
        super().learn_from(episode)

    def train(self) -> None:
        """PPO's epochs over the rollout, with the corrections in the loss."""
        if self._weight == 0.0 or not len(self._corrections.labels):
            super().train()
            return
        self.policy.set_training_mode(True)
        observations, labels = map(torch.as_tensor, self._corrections)
        for _ in range(self.n_epochs):
            for batch in self.rollout_buffer.get(self.batch_size):
                loss = self._ppo_loss(batch) + self._weight * mse_loss(self.means(observations), labels)
                self.policy.optimizer.zero_grad()
                loss.backward()
                torch.nn.utils.clip_grad_norm_(self.policy.parameters(), self.max_grad_norm)
                self.policy.optimizer.step()
            self._n_updates += 1

    def _ppo_loss(self, batch: RolloutBufferSamples) -> torch.Tensor:
        """The clipped surrogate, value and entropy loss of a minibatch, as in Stable-Baselines3's ``PPO.train``."""
        values, log_probability, entropy = self.policy.evaluate_actions(batch.observations, batch.actions)
        advantages = batch.advantages
        if len(advantages) > 1:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        ratio = torch.exp(log_probability - batch.old_log_prob)
        assert entropy is not None, 'a Gaussian policy has an entropy'
        clip = self.preset.ppo.clip_range
        surrogate = torch.min(advantages * ratio, advantages * ratio.clamp(1 - clip, 1 + clip)).mean()
        return (-surrogate - self.ent_coef * entropy.mean()
                + self.vf_coef * mse_loss(batch.returns, values.flatten()))
