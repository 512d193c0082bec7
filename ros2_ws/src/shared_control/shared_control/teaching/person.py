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

"""Whoever holds the keys in a simulation: what all simulated tutors have in common."""

from abc import ABC, abstractmethod

import numpy as np

from ..keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, Key, KeyMap, KeyMoment
from ..plant import PlantState
from ..rates import POLICY_PERIOD
from ..tasks.balance import BALANCE
from ..tasks.task import Task
from .picture import Eyes, Picture

ROUNDING = 1e-6
"""Times closer than this are equal, s."""

_STREAM = 1
"""Keeps a tutor's random numbers apart from the ball starts of the same seed."""


class SimulatedPerson(ABC):
    """Looks at the tray and presses one key at a time.

    As a ``Person`` (:mod:`shared_control_sim.local_plant`) it holds the keys of an environment in process; a node
    calls :meth:`look` and :meth:`key` and publishes what it returns.

    Args:
        task: its axes and keys.
        seed: of everything random.
        episodes: taught before.

    Raises:
        ValueError: the task has other axes than tutors know.
    """

    def __init__(self, task: Task = BALANCE, seed: int = 0, episodes: int = 0):
        self._task = task
        self._eyes = Eyes(task)
        self._episodes = episodes
        self._keys = KeyMoment(task.keys)
        self._start(seed)

    def reset(self, seed: int | None, episode: int | None = None) -> None:
        """A new episode: no keys held, nothing seen yet.

        Args:
            seed: begins the random numbers anew.
            episode: which it is, from 1; the next one when not given.
        """
        self._episodes = self._episodes + 1 if episode is None else episode
        self._start(seed)

    def _start(self, seed: int | None) -> None:
        if seed is not None:
            self._random = np.random.default_rng((seed, _STREAM))
        self._keys.release()
        self._steps = 0
        self._begin()

    @abstractmethod
    def _begin(self) -> None:
        """Forget the episode before."""

    def moment(self, state: PlantState) -> np.ndarray:
        """M_h for the coming policy period, (k,), N m (see ``Person``)."""
        key = self.key(self._steps * POLICY_PERIOD, self.look(state), self._keys.moment)
        self._steps += 1
        if key is not None:
            self._keys.press(key)
        return self._keys.moment

    def look(self, state: PlantState) -> Picture:
        """What there is to see of a plant."""
        return self._eyes.look(state)

    @abstractmethod
    def key(self, seconds: float, picture: Picture, held: np.ndarray) -> Key | None:
        """The key to press now, if any. Call at 50 Hz or so.

        Args:
            seconds: time, s; must not run backwards within an episode.
            picture: what there is to see now.
            held: M_h as the keys leave it now, (k,), N m.
        """


def in_keystrokes(moment: np.ndarray, at_least: int = 0) -> np.ndarray:
    """``moment``, (k,), N m, in whole keystrokes that can be held, ``at_least`` so many about every axis."""
    strokes = np.maximum(np.rint(np.abs(moment) / KEYSTROKE), at_least)
    return np.copysign(np.minimum(strokes * KEYSTROKE, HUMAN_MOMENT_LIMIT), moment)


def key_towards(wanted: np.ndarray, held: np.ndarray, keys: KeyMap) -> Key | None:
    """The key that brings ``held`` nearest to ``wanted``, (k,), N m; space when nothing is wanted."""
    lacking = wanted - held
    if not lacking.any():
        return None
    if not wanted.any():
        return Key.SPACE
    axis = int(np.abs(lacking).argmax())
    return next(key for key, (moves, sign) in keys.items() if moves == axis and sign * lacking[axis] > 0.0)
