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

"""A learner in one file: policy, settings, and all it takes to go on learning.

The file is safetensors; a JSON description stands in its header, so that both are written, and replaced, as one.
Nothing in it is executed when it is read.
"""

import dataclasses
import json
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_type_hints

import pydantic
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from shared_control.env import action_space, observation_space
from shared_control.files import write_atomically
from shared_control.plugins import TASKS, load
from shared_control.printable import shortened
from shared_control.tasks.task import Task

from .learner import Learner
from .presets import preset
from .wrong_content import what_is_wrong

FORMAT = 'shared-control policy 4'
SUFFIX = '.safetensors'
POLICY_NAME = f'policy{SUFFIX}'
"""Name of the file in a learner's folder."""
SIZE_MAX = 16 * 2**20
"""Bytes; a policy of two layers of 32 takes 40 thousand."""
_KEY = 'policy'

Count = Annotated[int, pydantic.Field(ge=0, lt=2**63)]
Name = Annotated[str, pydantic.Field(max_length=100)]


class Description(pydantic.BaseModel):
    """The JSON in the header of a policy file."""

    model_config = pydantic.ConfigDict(strict=True, extra='forbid')

    format: str
    preset: Name
    task: Name
    task_settings: dict[str, Any]
    settings: dict[str, Any]
    seed: Annotated[int, pydantic.Field(ge=0, lt=2**32)]
    episode: Count
    observation_space: dict[str, Any]
    action_space: dict[str, Any]


class PolicyFileError(ValueError):
    """A policy file is missing or unusable; the message names it and says why."""


def save_policy(learner: Learner, path: Path) -> None:
    """Write ``learner`` to ``path``, as a whole or not at all.

    Raises:
        PolicyFileError: the file would be larger than one that is read; what was there stays.
    """
    description = Description(
        format=FORMAT, preset=learner.name, task=learner.task.name, task_settings=dataclasses.asdict(learner.task),
        settings=dataclasses.asdict(learner.settings), seed=learner.seed, episode=learner.episode,
        **_spaces(learner.task))
    content = save(learner.tensors(), {_KEY: description.model_dump_json()})
    if len(content) > SIZE_MAX:
        raise PolicyFileError(f'{path} was not written: it would take {len(content)} bytes, and at most {SIZE_MAX} are '
                              'read; learn with smaller layers, or remember less')
    write_atomically(path, content)


def load_policy(path: Path) -> Learner:
    """The learner in ``path``, as it was when it was saved.

    Raises:
        PolicyFileError: there is no such file, or it is not what :func:`save_policy` writes.
    """
    try:
        description = Description.model_validate(read_description(path))
        learner = _learner(description)
        with safe_open(path, framework='pt') as file:
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118 - not a mapping
        for name, tensor in tensors.items():
            if not bool(torch.isfinite(tensor.double()).all()):  # of numbers of 8 bits it cannot be asked
                raise ValueError(f'{name} has numbers that are not finite')
        learner.restore(tensors)
    except PolicyFileError:
        raise
    except (SafetensorError, OSError, ValueError, TypeError, ArithmeticError) as error:
        raise PolicyFileError(f'{path} is no usable policy: {what_is_wrong(error)}') from error
    return learner


def read_description(path: Path) -> dict[str, Any]:
    """The JSON in the header of ``path`` (:class:`Description`), not yet checked but for its format.

    Raises:
        PolicyFileError: there is no such file, or it has no such header.
    """
    if not path.is_file():
        raise PolicyFileError(f'no policy file at {path}: name one that a session or train has written, {POLICY_NAME}')
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
        raise PolicyFileError(f'{path} is no policy of this version: format {shortened(found)}, expected {FORMAT!r}; '
                              'teach it anew, or use the version that wrote it')
    return description


def _learner(description: Description) -> Learner:
    """A fresh learner as described."""
    known = preset(description.preset)
    task = _validated(load(TASKS, description.task), description.task_settings, 'task_settings')
    settings = _validated(type(known.settings), description.settings, 'settings')
    for name, space in _spaces(task).items():
        if getattr(description, name) != space:
            raise ValueError(f'{name} is {shortened(getattr(description, name))}, expected {space}')
    made = dataclasses.replace(known, task=task, settings=settings).make(description.seed)
    made.episode = description.episode
    return made


def _validated(kind: type, stored: dict[str, Any], where: str) -> Any:
    """A dataclass of settings from its JSON: every field is there, no other, of its type and within its range."""
    text = json.dumps(stored)
    try:
        _all_fields(kind).model_validate_json(text)
        return pydantic.TypeAdapter(kind).validate_json(text, strict=True)
    except pydantic.ValidationError as error:
        raise ValueError(f'{where}.{what_is_wrong(error)}') from error


def _all_fields(kind: Any) -> Any:
    """A model of a dataclass whose fields must all be there, those of dataclasses in it as well."""
    if dataclasses.is_dataclass(kind) and isinstance(kind, type):
        hints = get_type_hints(kind, include_extras=True)
        fields: dict[str, Any] = {f.name: (_all_fields(hints[f.name]), ...) for f in dataclasses.fields(kind)}
        return pydantic.create_model(
            kind.__name__, __config__=pydantic.ConfigDict(strict=True, extra='forbid', allow_inf_nan=False), **fields)
    if isinstance(kind, UnionType):
        return Union[tuple(map(_all_fields, get_args(kind)))]  # noqa: UP007 - of as many as there are
    return kind


def _spaces(task: Task) -> dict[str, dict[str, Any]]:
    return {name: {'low': space.low.tolist(), 'high': space.high.tolist(), 'dtype': str(space.dtype)}
            for name, space in (('observation_space', observation_space(task)), ('action_space', action_space(task)))}
