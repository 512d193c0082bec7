# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The learn loop: the same for a live graph and for an environment in this process."""

import time
from collections.abc import Callable

import numpy as np
from shared_control.env import SharedControlEnv
from shared_control.plant import PlantInterrupted
from shared_control.verdict import Verdict

from .callbacks import Callbacks
from .episode import Episode
from .learner import Learner, Snapshot
from .threads import one_thread


def learn(learner: Learner, env: SharedControlEnv, episodes: int | None = None, callbacks: Callbacks | None = None,
          ) -> None:
    """Learn, one update an episode, until ``learner.episode`` is ``episodes`` or the callbacks say stop.

    An episode whose verdict is ``discard`` before the next one begins is unlearned, and its number is done again.

    Args:
        episodes: in all, those of an earlier run included; no end when None.
    """
    callbacks = callbacks or Callbacks()
    while (episodes is None or learner.episode < episodes) and not callbacks.should_stop():
        episode = Episode(env.task, learner.episode + 1)
        callbacks.episode_started(episode)
        try:
            run_episode(learner.explore, env, learner.begin(), episode, callbacks)
        except PlantInterrupted as error:
            callbacks.interrupted(error)
            continue
        before = Snapshot(learner)
        callbacks.learning_started(episode)
        started = time.monotonic()
        with one_thread():
            figures = learner.learn_from(episode)
        episode.learn_seconds = time.monotonic() - started
        try:
            callbacks.episode_learned(episode, figures)
        finally:  # whoever discards it and ends the session at once means both
            if episode.verdict is Verdict.DISCARD:
                before.put_back(learner)
                callbacks.episode_unlearned(episode)


def run_episode(act: Callable[[np.ndarray], np.ndarray], env: SharedControlEnv, seed: int, episode: Episode,
                callbacks: Callbacks) -> None:
    """One episode of ``act``, observation (n,) -> action (k,), written down in ``episode``.

    Raises:
        PlantInterrupted: the episode is void.
    """
    observation, _ = env.reset(seed=seed)
    ended = False
    while not ended:
        seen = observation
        action = act(seen)
        observation, reward, terminated, truncated, info = env.step(action)
        episode.add(seen, action, reward, info)
        callbacks.stepped(episode)
        ended = terminated or truncated
    episode.last_observation = observation
