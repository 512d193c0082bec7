"""A learner in one file: policy, settings, and all it takes to go on learning.

The file is safetensors; a JSON description stands in its header, so that both are written, and replaced, as one.
Nothing in it is executed when it is read. ``python -c "import safetensors; ..."`` or the two lines of
:func:`read_description` show the JSON.
"""

import dataclasses
import json
import math
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from shared_control.files import write_atomically
from shared_control.tasks.balance.settings import TaskSettings

from .coached_ppo import CoachedPPO
from .corrections import Corrections
from .episode_ppo import ACTION_SPACE, OBSERVATION_SPACE, EpisodePPO
from .learn import make_learner
from .presets import PRESETS, CoachingSettings, PpoSettings, Preset

FORMAT = 'shared-control policy 3'
SUFFIX = '.safetensors'
POLICY_NAME = f'policy{SUFFIX}'
"""Of the file in a learner's folder."""
SIZE_MAX = 16 * 2**20
"""Bytes; a policy of two layers of 32 takes 40 thousand."""
HIDDEN_MAX = (4, 1024)
"""Most hidden layers, and most units of one."""
CORRECTIONS_MAX = 100_000
"""Most remembered corrections; three episodes have 2,250 at most."""
_KEY = 'policy'
Settings = TypeVar('Settings')


class PolicyFileError(ValueError):
    """A policy file is missing or unusable; the message names it and says why."""


def save_policy(learner: EpisodePPO, path: Path) -> None:
    """Write ``learner`` to ``path``, as a whole or not at all."""
    description = {
        'format': FORMAT, 'preset': dataclasses.asdict(learner.preset), 'seed': learner.seed,
        'episode': learner.episode, 'steps': learner.num_timesteps,
        'observation_space': _describe(OBSERVATION_SPACE), 'action_space': _describe(ACTION_SPACE)}
    write_atomically(path, save(_tensors(learner) | _remembered(learner), {_KEY: json.dumps(description)}))


def load_policy(path: Path) -> EpisodePPO:
    """The learner in ``path``, as it was when it was saved.

    Raises:
        PolicyFileError: there is no such file, or it is not what :func:`save_policy` writes.
    """
    description = read_description(path)
    try:
        learner = _learner(description)
        with safe_open(path, framework='pt') as file:
            stored = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118 - not a mapping
    except (SafetensorError, OSError, KeyError, TypeError, ValueError) as error:
        raise PolicyFileError(f'{path} is no usable policy: {error}') from error
    expected, remembered = _tensors(learner), _remembered(learner)
    wanted = expected.keys() | remembered.keys()
    if stored.keys() != wanted:
        raise PolicyFileError(f'{path} is no usable policy: it should hold the tensors {", ".join(sorted(wanted))}; '
                              f'these differ: {", ".join(sorted(stored.keys() ^ wanted))}')
    rows = min((len(stored[name]) for name in remembered if stored[name].dim()), default=0)
    for name, tensor in stored.items():
        like = expected[name] if name in expected else remembered[name].new_empty(rows, remembered[name].shape[1])
        if tensor.shape != like.shape or tensor.dtype != like.dtype or rows > CORRECTIONS_MAX:
            raise PolicyFileError(f'{path} is no usable policy: {name} is {tensor.dtype} {tuple(tensor.shape)}, '
                                  f'expected {like.dtype} {tuple(like.shape)}')
        if not bool(torch.isfinite(tensor).all()):
            raise PolicyFileError(f'{path} is no usable policy: {name} has numbers that are not finite')
        if name in expected:
            expected[name].copy_(tensor)
    if isinstance(learner, CoachedPPO):
        learner.corrections = Corrections(*(stored[name] for name in remembered))
    return learner


def read_description(path: Path) -> dict[str, Any]:
    """The JSON in the header of ``path``: format, preset, spaces, seed, episode.

    Raises:
        PolicyFileError: there is no such file, or it has no such header.
    """
    if not path.is_file():
        raise PolicyFileError(f'no policy file at {path}')
    if path.stat().st_size > SIZE_MAX:
        raise PolicyFileError(f'{path} is no policy: {path.stat().st_size} bytes, at most {SIZE_MAX} are expected')
    try:
        with safe_open(path, framework='pt') as file:
            description = json.loads((file.metadata() or {})[_KEY])
        found = description['format']
    except KeyError as error:
        raise PolicyFileError(f'{path} is no policy: its header has no {error}') from error
    except (SafetensorError, OSError, ValueError, TypeError) as error:
        raise PolicyFileError(f'{path} is no policy: {error}') from error
    if found != FORMAT:
        raise PolicyFileError(f'{path} is no policy of this version: format {found!r}, expected {FORMAT!r}')
    return description


def _learner(description: dict[str, Any]) -> EpisodePPO:
    """A fresh learner as described. Raises KeyError, TypeError or ValueError when the description is wrong."""
    for name, space in (('observation_space', OBSERVATION_SPACE), ('action_space', ACTION_SPACE)):
        if description[name] != _describe(space):
            raise ValueError(f'{name} is {description[name]}, expected {_describe(space)}')
    stored = description['preset']
    if stored['name'] not in PRESETS:
        raise ValueError(f'no preset {stored["name"]!r}; there are {", ".join(PRESETS)}')
    preset = Preset(
        stored['name'], _settings(TaskSettings, stored['task']), _settings(PpoSettings, stored['ppo']),
        None if stored['coaching'] is None else _settings(CoachingSettings, stored['coaching']))
    for hidden in (preset.ppo.hidden, preset.ppo.value_hidden):
        if len(hidden) > HIDDEN_MAX[0] or any(not 0 < n <= HIDDEN_MAX[1] for n in hidden):
            raise ValueError(f'hidden layers {hidden}; at most {HIDDEN_MAX[0]} of {HIDDEN_MAX[1]} units')
    learner = make_learner(preset, _count(description, 'seed'))
    learner.episode = _count(description, 'episode')
    learner.num_timesteps = _count(description, 'steps')
    return learner


def _settings(kind: type[Settings], stored: dict[str, Any]) -> Settings:
    """A dataclass of settings from its JSON, checked field by field."""
    hints = get_type_hints(kind)
    if stored.keys() != hints.keys():
        raise ValueError(f'{kind.__name__} should have {", ".join(hints)}')
    values = {}
    for name, value in stored.items():
        if isinstance(value, list):
            value = tuple(value)
        numbers = value if isinstance(value, tuple) else (value,)
        if not all(n is None or (isinstance(n, int | float) and math.isfinite(n)) for n in numbers):
            raise ValueError(f'{kind.__name__}.{name} is {value!r}, not a finite number')
        values[name] = value
    return kind(**values)


def _count(description: dict[str, Any], name: str) -> int:
    value = description[name]
    if not isinstance(value, int) or not 0 <= value < 2**63:
        raise ValueError(f'{name} is {value!r}, not a count')
    return value


def _describe(space) -> dict[str, Any]:
    return {'low': space.low.tolist(), 'high': space.high.tolist(), 'dtype': str(space.dtype)}


def _tensors(learner: EpisodePPO) -> dict[str, torch.Tensor]:
    """The tensors that a learner lives in, by name: weights, and Adam's moments and step counts.

    Copying into them changes the learner.
    """
    optimizer = learner.policy.optimizer
    tensors = {}
    for name, parameter in learner.policy.named_parameters():
        state = optimizer.state[parameter]
        if not state:  # as Adam itself starts
            state.update(step=torch.tensor(0.0), exp_avg=torch.zeros_like(parameter),
                         exp_avg_sq=torch.zeros_like(parameter))
        tensors[f'policy.{name}'] = parameter.data
        for key in ('step', 'exp_avg', 'exp_avg_sq'):
            tensors[f'adam.{key}.{name}'] = state[key]
    return tensors


def _remembered(learner: EpisodePPO) -> dict[str, torch.Tensor]:
    """The corrections that a coached learner still learns from, by name; as many rows as there are."""
    if not isinstance(learner, CoachedPPO):
        return {}
    return {f'corrections.{f.name}': getattr(learner.corrections, f.name)
            for f in dataclasses.fields(learner.corrections)}
