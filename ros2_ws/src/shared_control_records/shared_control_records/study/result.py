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

"""What a run leaves behind: ``result.json`` and the tracks of its tests, ``tests.npz``."""

import io
import json
import zipfile
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, TypeAdapter, with_config
from shared_control.files import write_atomically
from shared_control_learning.evaluation.result import TRACKS, ProtocolResult
from shared_control_learning.wrong_content import what_is_wrong

from .plan import Job

RESULT = 'result.json'
TESTS = 'tests.npz'
NUMBERS = ('episode', 'seconds', 'return', 'fallen', 'mean_abs_human', 'mean_abs_agent', 'intervention_rate')
"""What a report needs of every episode of a run."""
TESTS_MOST = 256 * 2**20
"""Bytes that the arrays of a run may take together. All tests of a run take 6 MB, and 0.2 MB more each checkpoint."""
_ARRAYS = ('seconds', *TRACKS, 'fallen', 'success')
"""What there is of each test."""


class ResultError(ValueError):
    """The result of a run cannot be read; the message names the file."""


@with_config(ConfigDict(extra='forbid', allow_inf_nan=False, arbitrary_types_allowed=True))
@dataclass(frozen=True, eq=False)
class RunResult:
    """A run that is done."""

    participant: int
    group: str
    simulated: bool
    """Whether the participant was a model of one."""
    condition: str
    taught: bool
    seed: int
    cap: int
    """Episodes after which training ended in any case."""
    first_pass: int | None
    """Episodes before the first test passed alone."""
    skilled: int | None
    """Episodes before the second of two tests in a row was passed; for a real participant, episodes until they said
    that it has learned it, if it then passed. None: censored at the last episode."""
    seconds: float
    """Time of computing; for a real participant, of teaching, with episodes that were discarded or broken off."""
    episodes: list[dict[str, Any]]
    """Rows of ``episodes.csv`` whose episodes the robot has learned from, numbers as numbers. None: there is no policy,
    and the run counts as lost in every test."""
    tlx: dict[str, float] | None = None
    """Raw NASA-TLX of a real participant, by scale, 0..100."""
    tests: dict[str, ProtocolResult] = field(default_factory=dict)
    """By the name of the test; none of a run without a policy."""


_RUN_RESULT = TypeAdapter(RunResult)


class Brief(BaseModel):
    """What is told of a run as soon as it is done."""

    model_config = ConfigDict(strict=True, allow_inf_nan=False)

    seconds: float
    skilled: int | None


def save_result(result: RunResult, folder: Path) -> None:
    """Keep a result. ``result.json`` comes last and as a whole: a run that has one is done."""
    arrays: dict[str, Any] = {f'{name}/{track}': getattr(test, track).astype(np.float32)
                              for name, test in result.tests.items() for track in ('seconds', *TRACKS)}
    arrays |= {f'{name}/{track}': getattr(test, track)
               for name, test in result.tests.items() for track in ('fallen', 'success')}
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)
    write_atomically(folder / TESTS, packed.getvalue())
    content = {f.name: getattr(result, f.name) for f in fields(result) if f.name != 'tests'}
    write_atomically(folder / RESULT, (json.dumps(content, indent=1, allow_nan=False) + '\n').encode())


def load_result(folder: Path) -> RunResult | None:
    """The result in a run's folder; None when the run is not done.

    Raises:
        ResultError: what is there is damaged, or a part of it is missing.
    """
    if not is_done(folder):
        return None
    try:
        content = json.loads((folder / RESULT).read_text(encoding='utf-8'))
        _check_arrays(folder / TESTS)
        with np.load(folder / TESTS, allow_pickle=False) as packed:
            names = dict.fromkeys(name.rpartition('/')[0] for name in packed.files)
            tests = {name: ProtocolResult(name, **{key: packed[f'{name}/{key}'] for key in _ARRAYS}) for name in names}
        return _RUN_RESULT.validate_python({**content, 'tests': tests})
    except Exception as error:  # a damaged zip or JSON file raises errors of many kinds
        raise _damaged(folder, error) from error


def _check_arrays(path: Path) -> None:
    """Refuse what is not of a test, or would take all memory, before anything of it is unpacked."""
    with zipfile.ZipFile(path) as packed:
        members = packed.infolist()
    unknown = [member.filename for member in members
               if member.filename.rpartition('/')[2] not in [f'{name}.npy' for name in _ARRAYS]]
    if unknown:
        raise ValueError(f'{path.name} has {unknown[0]!r}, expected of each test {", ".join(_ARRAYS)}')
    size = sum(member.file_size for member in members)
    if size > TESTS_MOST:
        raise ValueError(f'{path.name} has {size} bytes unpacked, expected {TESTS_MOST} at the most')


def load_brief(folder: Path) -> Brief:
    """The part of a result that is told, without reading the tracks of its tests.

    Raises:
        ResultError: there is none, or it is damaged.
    """
    try:
        return Brief.model_validate_json((folder / RESULT).read_bytes())
    except (OSError, ValueError) as error:
        raise _damaged(folder, error) from error


def _damaged(folder: Path, error: Exception) -> ResultError:
    return ResultError(f'the result in {folder} is damaged ({what_is_wrong(error)}): '
                       f'remove {folder / RESULT} and run the study again')


def is_done(folder: Path) -> bool:
    """Whether a run has its result."""
    return (folder / RESULT).is_file()


def describe(job: Job, simulated: bool) -> dict[str, Any]:
    """What a result says of its job."""
    return {'participant': job.participant.number, 'group': job.participant.group, 'simulated': simulated,
            'condition': job.condition.name, 'taught': job.condition.taught, 'seed': job.participant.seed,
            'cap': job.condition.episodes}


def check_result(result: RunResult, job: Job, simulated: bool, folder: Path) -> None:
    """Refuse what another run has left in a run's folder, and a table of episodes of which no report can be made.

    Raises:
        ResultError: the message names the file and what is wrong.
    """
    for key, value in describe(job, simulated).items():
        if (found := getattr(result, key)) != value:
            raise ResultError(f'{folder / RESULT} is of another run: {key} is {found!r}, not {value!r}; move it and '
                              f'{TESTS} away, and the run is done again')
    if result.skilled is not None and result.skilled > len(result.episodes):
        raise _damaged(folder, ValueError(f'skilled after {result.skilled} of {len(result.episodes)} episodes'))
    for row in result.episodes:
        if missing := [name for name in NUMBERS if not isinstance(row.get(name), int | float)]:
            raise _damaged(folder, ValueError(f'an episode has no number {missing[0]}'))
