"""A linear policy by the cross-entropy method (Rubinstein, 1999): each episode tries one, the best make the next."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from shared_control import BALANCE, Episode, Preset, Task
from shared_control.seeds import episode_seed


@dataclass(frozen=True)
class CrossEntropySettings:
    """Kept with every policy."""

    population: int = 10
    """Episodes of a generation."""
    elites: int = 3
    """The best of them, of which the next generation is made."""
    initial_std: float = 1.0
    """Of the weights, actions per unit of the observation."""
    std_min: float = 0.02


class CrossEntropyLearner:
    """A :class:`shared_control.Learner` of weights (k, n + 1): action = weights @ (observation, 1)."""

    def __init__(self, name: str, task: Task, settings: CrossEntropySettings, seed: int):
        self.name, self.task, self.settings, self.seed = name, task, settings, seed
        self.episode = 0
        shape = (len(task.axes), task.observed_size + 1)
        self._state = {
            'mean': np.zeros(shape), 'std': np.full(shape, settings.initial_std),
            'tried': np.zeros((0, *shape)), 'scores': np.zeros(0)}
        self._candidate = self._state['mean']

    def begin(self) -> int:
        """See Learner: the weights that this episode tries follow from its seed."""
        seed = episode_seed(self.seed, self.episode + 1)
        noise = np.random.default_rng(seed).normal(size=self._state['mean'].shape)
        self._candidate = self._state['mean'] + self._state['std'] * noise
        return seed

    def explore(self, observation: np.ndarray) -> np.ndarray:
        """See Learner."""
        return (self._candidate @ np.append(observation, 1.0)).astype(np.float32)

    def act(self, observation: np.ndarray) -> np.ndarray:
        """See Learner."""
        return (self._state['mean'] @ np.append(observation, 1.0)).clip(-1.0, 1.0).astype(np.float32)

    def learn_from(self, episode: Episode) -> dict[str, float]:
        """See Learner."""
        state = self._state
        state['tried'] = np.append(state['tried'], self._candidate[np.newaxis], axis=0)
        score = len(episode) + sum(episode.rewards)  # first how long it went well, then how well
        state['scores'] = np.append(state['scores'], score)
        if len(state['scores']) >= self.settings.population:
            best = state['tried'][np.argsort(state['scores'])[-self.settings.elites:]]
            state.update(mean=best.mean(axis=0), std=np.maximum(best.std(axis=0), self.settings.std_min),
                         tried=state['tried'][:0], scores=state['scores'][:0])
        self.episode += 1
        return {'train/std': float(state['std'].mean())}

    def tensors(self) -> dict[str, torch.Tensor]:
        """See Learner."""
        return {name: torch.tensor(value) for name, value in self._state.items()}

    def restore(self, tensors: Mapping[str, torch.Tensor]) -> None:
        """See Learner."""
        if tensors.keys() != self._state.keys():
            raise ValueError(f'it should hold the tensors {", ".join(self._state)}, not {", ".join(tensors)}')
        rows = len(tensors['scores'])
        for name, own in self._state.items():
            shape = own.shape if name in ('mean', 'std') else (rows, *own.shape[1:])
            if tensors[name].shape != shape or tensors[name].dtype != torch.float64:
                raise ValueError(f'{name} is {tensors[name].dtype} {tuple(tensors[name].shape)}, expected {shape}')
        self._state = {name: tensors[name].numpy().copy() for name in self._state}


@dataclass(frozen=True)
class CrossEntropyPreset(Preset):
    """The entry point names an instance of it."""

    settings: Any

    def make(self, seed: int = 0) -> CrossEntropyLearner:
        """See Preset."""
        return CrossEntropyLearner(self.name, self.task, self.settings, seed)


CROSS_ENTROPY = CrossEntropyPreset('cross_entropy', BALANCE, CrossEntropySettings())
