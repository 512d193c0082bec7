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

"""Episodes of balls that roll between walls, without a robot: what a learner learns from, in no time."""

from types import SimpleNamespace

import numpy as np
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.task import INTEGRAL_BOUND, Observer
from shared_control_learning.episode import Episode

GAIN, WALL = 0.05, 1.86


def rolling(task, choose, seed, steps=600, human=None):
    """An episode of balls between walls, one along each axis: tilt follows the moment, velocity the tilt."""
    random = np.random.default_rng(seed)
    axes = len(task.axes)
    error, velocity, tilt = random.uniform(-1.5, 1.5, axes), np.zeros(axes), np.zeros(axes)
    observer, episode = Observer(task), Episode(task)

    def seen():
        raw = np.array([*error, *velocity, *tilt], np.float32)
        episode.last_observation = np.append(raw, observer._integral).astype(np.float32) if task.integrates else raw
        return episode.last_observation

    for number in range(steps):
        observation = seen()
        action = choose(observation)
        held = np.zeros(axes) if human is None else np.full(axes, human(number, error)) / task.scale
        applied = np.clip(action + held, -2.5, 2.5)
        tilt = tilt + 0.15 * (0.8 * applied + 0.1 - tilt)
        velocity = velocity + GAIN * tilt
        error = error - 1.5 * POLICY_PERIOD * velocity
        hit = np.abs(error) > WALL
        error, velocity = np.clip(error, -WALL, WALL), np.where(hit, 0.0, velocity)
        if task.integrates:
            observer._integral = np.clip(observer._integral + POLICY_PERIOD * error, -INTEGRAL_BOUND, INTEGRAL_BOUND)
        reward = float(-0.03 * (error ** 2).sum())
        episode.add(observation, np.asarray(action, np.float32), reward, {
            'human': held * task.scale, 'agent': action * task.scale, 'applied': applied * task.scale, 'failed': False,
            'reward_terms': {}, 'state': SimpleNamespace(position_error=float(np.abs(error).max()), velocity=0.0),
            'on_tray': None})
    seen()
    return episode
