"""A learner in one file: policy, settings, and all it takes to go on learning.

The file is safetensors; a JSON description stands in its header, so that both are written, and replaced, as one.
Nothing in it is executed when it is read. ``python -c "import safetensors; ..."`` or the two lines of
:func:`read_description` show the JSON.
"""

import dataclasses
import json
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import torch
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, create_model
from safetensors import SafetensorError, safe_open
from safetensors.torch import save

from ..files import write_atomically
from ..task.settings import TaskSettings
from ..wrong_content import shortened, what_is_wrong
from .coached_ppo import CoachedPPO
from .corrections import Corrections
from .episode_ppo import ACTION_SPACE, OBSERVATION_SPACE, EpisodePPO
from .learn import make_learner
from .presets import CoachingSettings, NotNegative, Positive, PpoSettings, Preset, preset

FORMAT = 'shared-control policy 3'
SUFFIX = '.safetensors'
POLICY_NAME = f'policy{SUFFIX}'
"""Of the file in a learner's folder."""
SIZE_MAX = 16 * 2**20
"""Bytes; a policy of two layers of 32 takes 40 thousand."""
CORRECTIONS_MAX = 100_000
"""Most remembered corrections; three episodes have 2,250 at most."""
_KEY = 'policy'
_Count = Annotated[int, Field(ge=0, lt=2**63)]


class PolicyFileError(ValueError):
    """A policy file is missing or unusable; the message names it and says why."""


def _model(**kinds: Any) -> type[BaseModel]:
    """A model of JSON: all of its fields must be there, no other, and all numbers are finite."""
    needed: dict[str, Any] = {name: (kind, ...) for name, kind in kinds.items()}
    config = ConfigDict(strict=True, extra='forbid', allow_inf_nan=False)
    return create_model('Stored', __config__=config, **needed)


def _settings(kind: type, **ranges: Any) -> type[BaseModel]:
    """A model of the JSON of a dataclass, some of whose fields have ranges of their own here."""
    return _model(**get_type_hints(kind, include_extras=True) | ranges)


_Task = _settings(
    TaskSettings, episode_seconds=Positive, action_scale=Positive, moment_limit=Positive, reward_scale=Positive,
    observation_scales=tuple[Positive, Positive, Positive] | None, position_error_max_squared=Positive,
    weight_pitch=NotNegative, weight_velocity=NotNegative, weight_margin=NotNegative, weight_position=NotNegative,
    weight_manipulability=NotNegative, rate_centre=Annotated[float, Field(le=0.0)])
_Preset = _model(
    name=Annotated[str, Field(max_length=100), AfterValidator(lambda name: preset(name).name)], task=_Task,
    ppo=_settings(PpoSettings), coaching=_settings(CoachingSettings) | None)
_Description = _model(
    format=str, preset=_Preset, seed=Annotated[int, Field(ge=0, lt=2**32)], episode=_Count, steps=_Count,
    observation_space=dict[str, Any], action_space=dict[str, Any])


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
    except (SafetensorError, OSError, ValueError, RecursionError) as error:
        raise PolicyFileError(f'{path} is no usable policy: {what_is_wrong(error)}') from error
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
    except (SafetensorError, OSError, ValueError, TypeError, RecursionError) as error:
        raise PolicyFileError(f'{path} is no policy: {what_is_wrong(error)}') from error
    if found != FORMAT:
        raise PolicyFileError(f'{path} is no policy of this version: format {shortened(found)}, expected {FORMAT!r}')
    return description


def _learner(description: dict[str, Any]) -> EpisodePPO:
    """A fresh learner as described. Raises ValueError when the description is wrong."""
    # By way of JSON, in which a list stands for a tuple.
    found = _Description.model_validate_json(json.dumps(description)).model_dump()
    for name, space in (('observation_space', OBSERVATION_SPACE), ('action_space', ACTION_SPACE)):
        if found[name] != _describe(space):
            raise ValueError(f'{name} is {shortened(found[name])}, expected {_describe(space)}')
    stored = found['preset']
    preset = Preset(stored['name'], TaskSettings(**stored['task']), PpoSettings(**stored['ppo']),
                    None if stored['coaching'] is None else CoachingSettings(**stored['coaching']))
    learner = make_learner(preset, found['seed'])
    learner.episode, learner.num_timesteps = found['episode'], found['steps']
    return learner


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
