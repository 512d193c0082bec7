"""PPO that a person's corrections teach directly, as well."""

import numpy as np
import torch
from stable_baselines3.common.type_aliases import RolloutBufferSamples
from torch.nn.functional import mse_loss

from .corrections import NONE, find_corrections
from .episode import Episode
from .episode_ppo import EpisodePPO
from .presets import Preset


class CoachedPPO(EpisodePPO):
    """Adds ``lambda |pi(s) - y|^2``, the weighted mean over the corrections of the last episodes, to PPO's loss.

    Corrective advice as labels of a network: COACH (Celemin and Ruiz-del-Solar, 2019) and D-COACH (Perez-Dattari et
    al., 2018), which also credit advice to a window of the past, and replay it; beside a reward, as PVP (Peng et al.,
    2023) does. Without corrections it is PPO, to the bit.
    """

    def __init__(self, preset: Preset, seed: int = 0):
        super().__init__(preset, seed)
        self.corrections = NONE
        """Of the last episodes."""
        self._weight = 0.0

    def learn_from(self, episode: Episode) -> None:
        """One update from a finished episode and from the corrections of the last ones."""
        coaching = self.preset.coaching
        assert coaching is not None, f'preset {self.preset.name!r} has no coaching settings'
        number = self.episode + 1
        with torch.no_grad():
            means = self.means(torch.as_tensor(np.array(episode.observations))).clamp(-1.0, 1.0).numpy()
        found = find_corrections(episode, number, means, coaching, self.preset.task.action_scale)
        self.corrections = self.corrections.since(number - coaching.memory_episodes + 1).followed_by(found)
        self._weight = coaching.weight_in(number)
        super().learn_from(episode)

    def train(self) -> None:
        """PPO's epochs over the rollout, with the corrections in the loss."""
        if self._weight == 0.0 or not len(self.corrections):
            super().train()
            return
        self.policy.set_training_mode(True)
        self._update_learning_rate(self.policy.optimizer)
        for _ in range(self.n_epochs):
            for batch in self.rollout_buffer.get(self.batch_size):
                loss = self._ppo_loss(batch) + self._weight * self._coaching_loss()
                self.policy.optimizer.zero_grad()
                loss.backward()
                torch.nn.utils.clip_grad_norm_(self.policy.parameters(), self.max_grad_norm)
                self.policy.optimizer.step()
            self._n_updates += 1
        self.logger.record('train/coaching_loss', float(self._coaching_loss().detach()))
        self.logger.record('train/coaching_weight', self._weight)

    def _coaching_loss(self) -> torch.Tensor:
        """Weighted mean of ``|pi(s) - y|^2`` over the corrections."""
        squares = (self.means(self.corrections.observations) - self.corrections.labels) ** 2
        return (self.corrections.weights * squares).sum() / self.corrections.weights.sum()

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
