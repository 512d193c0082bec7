"""The learn loop: the same for a live graph and for an environment in this process."""

import time

import numpy as np
from shared_control.env import BalanceEnv
from shared_control.plant import PlantInterrupted

from .callbacks import Hooks
from .coached_ppo import CoachedPPO
from .episode import Episode
from .episode_ppo import EpisodePPO
from .presets import Preset
from .record import EpisodeRecord


def make_learner(preset: Preset, seed: int = 0) -> EpisodePPO:
    """The learner of a preset."""
    return EpisodePPO(preset, seed) if preset.coaching is None else CoachedPPO(preset, seed)


def warm_up(preset: Preset) -> None:
    """Choose and learn once with a learner of no consequence.

    Torch loads parts of itself when they are first used, which takes seconds: too long in a live episode.
    """
    learner = make_learner(preset)
    seen = np.zeros(3, np.float32)
    episode = Episode(last_observation=seen)
    for _ in range(preset.ppo.batch_size):
        episode.add(seen, learner.explore(seen), 0.0, 1.0, 1.0)
    learner.learn_from(episode)


def learn(learner: EpisodePPO, env: BalanceEnv, episodes: int | None = None, hooks: Hooks | None = None) -> None:
    """Learn, one update an episode, until ``learner.episode`` is ``episodes`` or the hooks say stop.

    Args:
        episodes: in all, those of an earlier run included; no end when None.
    """
    hooks = hooks or Hooks()
    while (episodes is None or learner.episode < episodes) and not hooks.stop():
        record = EpisodeRecord(learner.episode + 1, 'teach')
        hooks.episode_started(record)
        try:
            episode = run_episode(learner, env, record, hooks)
        except PlantInterrupted as error:
            hooks.interrupted(error)
            continue
        hooks.learning_started(record)
        started = time.monotonic()
        learner.learn_from(episode)
        record.learn_seconds = time.monotonic() - started
        hooks.episode_learned(record)


def run_episode(learner: EpisodePPO, env: BalanceEnv, record: EpisodeRecord, hooks: Hooks) -> Episode:
    """One exploring episode."""
    learner.start_episode()
    observation, _ = env.reset(seed=learner.episode_seed())
    episode = Episode()
    ended = False
    while not ended:
        seen = observation
        action = learner.explore(seen)
        observation, reward, terminated, truncated, info = env.step(action)
        episode.add(seen, action, reward, info['m_y_human'], info['m_y_applied'])
        record.add(info)
        hooks.stepped(record)
        ended = terminated or truncated
    episode.last_observation = observation
    episode.terminated = terminated
    return episode
