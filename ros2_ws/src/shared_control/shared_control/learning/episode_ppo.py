"""Stable-Baselines3's PPO with one update an episode."""

from typing import Any

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.utils import set_random_seed

from ..seeds import episode_seed
from .episode import Choice, Episode, rollout_buffer
from .presets import Preset

OBSERVATION_SPACE = gymnasium.spaces.Box(-20.0, 20.0, (3,), np.float32)
ACTION_SPACE = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)


class EpisodePPO(PPO):
    """PPO whose rollout is one episode, however long that is; the update itself is Stable-Baselines3's.

    The environment is not stepped from here: :func:`shared_control.learning.learn.learn` does that, since only
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
            policy_kwargs={'net_arch': list(settings.hidden), 'log_std_init': float(np.log(settings.initial_std))})
        self.observation_space = OBSERVATION_SPACE
        self.action_space = ACTION_SPACE
        self.n_envs = 1
        self._setup_model()
        self.set_logger(Logger(None, []))
        self.preset = preset
        self.episode = 0
        """Episodes learned from so far."""

    def episode_seed(self) -> int:
        """The seed of the coming episode, for plant and tutor; 31 bits."""
        return episode_seed(self.seed or 0, self.episode + 1)

    def start_episode(self) -> None:
        """Begin the random numbers of the coming episode."""
        set_random_seed(self.episode_seed())

    @torch.no_grad()
    def choose(self, observation: np.ndarray) -> Choice:
        """Draw an action for ``observation`` (3,)."""
        action, value, log_probability = self.policy(torch.as_tensor(observation).unsqueeze(0))
        return Choice(observation, action[0].numpy(), value[0], log_probability)

    @torch.no_grad()
    def mean_actions(self, observations: np.ndarray) -> np.ndarray:
        """What the policy does without exploring, clipped to the action space; (n, 3) -> (n, 1)."""
        means = self.policy.get_distribution(torch.as_tensor(observations)).mode()
        return means.clamp(-1.0, 1.0).numpy()

    def act(self, observation: np.ndarray) -> np.ndarray:
        """The action without exploring; (3,) -> (1,)."""
        return self.mean_actions(observation[None])[0]

    def learn_from(self, episode: Episode) -> None:
        """One update from a finished episode."""
        assert episode.last_observation is not None, 'the episode has not ended'
        settings = self.preset.ppo
        with torch.no_grad():
            last_value = self.policy.predict_values(torch.as_tensor(episode.last_observation).unsqueeze(0))
        self.rollout_buffer = rollout_buffer(
            episode, last_value, OBSERVATION_SPACE, ACTION_SPACE, settings.gamma, settings.gae_lambda)
        self.num_timesteps += len(episode)
        self.train()
        self.episode += 1

    def learn(self, *_: Any, **__: Any) -> 'EpisodePPO':
        """Not this way: see :func:`shared_control.learning.learn.learn`."""
        raise NotImplementedError('use shared_control.learning.learn.learn')
