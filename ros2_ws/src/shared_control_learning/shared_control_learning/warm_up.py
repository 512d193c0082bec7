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

"""What a live session cannot wait for."""

from types import SimpleNamespace

import numpy as np

from .episode import Episode
from .presets import Preset

_STEPS = 128


def warm_up(preset: Preset) -> None:
    """Choose and learn once with a learner of no consequence.

    Torch loads parts of itself when they are first used, which takes seconds: too long in a live episode.
    """
    learner = preset.make()
    task = preset.task
    seen = np.zeros(task.observed_size, np.float32)
    episode = Episode(task, last_observation=seen)
    still = SimpleNamespace(position_error=0.0, velocity=0.0)
    held = np.ones(len(task.axes))
    for _ in range(_STEPS):
        episode.add(seen, learner.explore(seen), 0.0, {
            'human': held, 'agent': held, 'applied': held, 'state': still, 'reward_terms': {}, 'failed': False})
    learner.learn_from(episode)
