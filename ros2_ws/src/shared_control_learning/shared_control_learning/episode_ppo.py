"""Stable-Baselines3's PPO with one update an episode."""

import math
from typing import Any

import gymnasium
import numpy as np
import torch
from shared_control.rates import POLICY_PERIOD
from shared_control.seeds import episode_seed
from shared_control.tasks.balance.task import OBSERVATION_BOUND
from stable_baselines3 import PPO
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.utils import set_random_seed

from .episode import Episode
from .presets import Preset

OBSERVATION_SPACE = gymnasium.spaces.Box(-OBSERVATION_BOUND, OBSERVATION_BOUND, (3,), np.float32)
ACTION_SPACE = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)


class EpisodePPO(PPO):
    """PPO whose rollout is one episode, however long that is; the update itself is Stable-Baselines3's.

    The environment is not stepped from here: :func:`shared_control_learning.learn.learn` does that, since only
    between episodes a live graph has time for an update.

    Random numbers (exploration, order of minibatches) depend on ``seed`` and on the episode's number alone, so a
    learner that resumes from a checkpoint goes on as if it had never stopped.

    Args:
        preset: task and settings.
        seed: of the first weights and of everything random after them.
    """

    def __init__(self, preset: Preset, seed: int = 0):
        settings = preset.ppo
        torch.set_num_threads(1)
        super().__init__(
            'MlpPolicy', None, learning_rate=settings.learning_rate, batch_size=settings.batch_size,  # type: ignore[arg-type]
            n_epochs=settings.epochs, gamma=settings.gamma, gae_lambda=settings.gae_lambda,
            clip_range=settings.clip_range, ent_coef=settings.entropy_weight, vf_coef=settings.value_weight,
            max_grad_norm=settings.max_gradient_norm, seed=seed, device='cpu', _init_setup_model=False,
            policy_kwargs={'net_arch': {'pi': list(settings.hidden), 'vf': list(settings.value_hidden)},
                           'log_std_init': float(np.log(settings.initial_std))})
        self.observation_space = OBSERVATION_SPACE
        self.action_space = ACTION_SPACE
        self.n_envs = 1
        self._setup_model()
        self.set_logger(Logger(None, []))
        self._kept = math.exp(-POLICY_PERIOD / settings.noise_seconds) if settings.noise_seconds else 0.0
        """Correlation of the noise from one step to the next."""
        self._noise = torch.zeros(1)
        self.lr_schedule = lambda _: settings.learning_rate_in(self.episode + 1)
        self.policy.log_std.requires_grad_(settings.std_decay is None)
        self.preset = preset
        self.episode = 0
        """Episodes learned from so far."""

    def episode_seed(self) -> int:
        """The seed of the coming episode, for plant and tutor; 31 bits."""
        return episode_seed(self.seed or 0, self.episode + 1)

    def start_episode(self) -> None:
        """Begin the random numbers of the coming episode."""
        set_random_seed(self.episode_seed())
        self._noise = torch.randn(1)
        std = self.preset.ppo.std_in(self.episode + 1)
        if std is not None:
            self.policy.log_std.data.fill_(math.log(std))

    @torch.no_grad()
    def explore(self, observation: np.ndarray) -> np.ndarray:
        """An action drawn for ``observation``; (3,) -> (1,), not clipped.

        Every action is Gaussian, as PPO takes it to be; those that follow each other may be correlated (Hollenstein
        et al., 2024), since a tray does not heed what changes its sign every 20 ms.
        """
        noise = self._noise
        self._noise = self._kept * noise + math.sqrt(1.0 - self._kept ** 2) * torch.randn(1)
        return (self.means(torch.as_tensor(observation)) + self.policy.log_std.exp() * noise).numpy()

    @torch.no_grad()
    def act(self, observation: np.ndarray) -> np.ndarray:
        """The action without exploring; (3,) -> (1,)."""
        return self.means(torch.as_tensor(observation)).clamp(-1.0, 1.0).numpy()

    def means(self, observations: torch.Tensor) -> torch.Tensor:
        """Means of the Gaussian policy, not clipped; (..., 3) -> (..., 1)."""
        return self.policy.action_net(self.policy.mlp_extractor.forward_actor(observations))

    def learn_from(self, episode: Episode) -> None:
        """One update from a finished episode."""
        self.rollout_buffer = self._rollout(episode)
        self.num_timesteps += len(episode)
        self.train()
        self.episode += 1

    @torch.no_grad()
    def _rollout(self, episode: Episode) -> RolloutBuffer:
        """The episode as Stable-Baselines3 has it, with advantages; as long as the episode is."""
        assert episode.last_observation is not None, 'the episode has not ended'
        observations, actions = np.array(episode.observations), np.array(episode.actions)
        values, log_probabilities, _ = self.policy.evaluate_actions(
            torch.as_tensor(observations), torch.as_tensor(actions))
        buffer = RolloutBuffer(len(episode), OBSERVATION_SPACE, ACTION_SPACE, device='cpu',
                               gamma=self.gamma, gae_lambda=self.gae_lambda)
        for step, reward in enumerate(episode.rewards):
            buffer.add(observations[step], actions[step], np.array([reward]), np.array([step == 0]),
                       values[step], log_probabilities[step])
        last_value = self.policy.predict_values(torch.as_tensor(episode.last_observation).unsqueeze(0))
        buffer.compute_returns_and_advantage(last_value, np.array([episode.terminated]))
        return buffer

    def learn(self, *_: Any, **__: Any) -> 'EpisodePPO':
        """Not this way: see :func:`shared_control_learning.learn.learn`."""
        raise NotImplementedError('use shared_control_learning.learn.learn')
