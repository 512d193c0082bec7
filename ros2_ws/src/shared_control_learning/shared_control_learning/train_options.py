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

"""The options of ``shared-control train``, which a run keeps: one that goes on goes on with them."""

import argparse
import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, ClassVar

from shared_control.files import write_atomically

OPTIONS_NAME = 'options.json'


@dataclass(frozen=True)
class TrainOptions:
    """What is trained, and how; as they are when an option is not given."""

    __pydantic_config__: ClassVar[dict[str, Any]] = {'extra': 'forbid', 'strict': True}

    task: str = ''
    preset: str = ''
    physics: str = 'bullet'
    profile: str = ''
    sharing: str = 'additive'
    human_only: bool = False
    seed: int = 0
    episodes: int = 20
    until_skilled: bool = False
    evaluate_every: int = 1


def options_of(args: argparse.Namespace) -> TrainOptions:
    """What was given, over what the run to go on with was begun with, if there is one.

    Raises:
        ValueError: the options of that run cannot be read.
    """
    from pydantic import TypeAdapter  # late, as the next: `--help` need not wait for it

    from .wrong_content import what_is_wrong
    given = {field.name: getattr(args, field.name) for field in fields(TrainOptions) if hasattr(args, field.name)}
    path = args.resume / OPTIONS_NAME if args.resume else None
    if path is None or not path.exists():  # an older version has not kept them
        return TrainOptions(**given)
    try:
        return TrainOptions(**asdict(TypeAdapter(TrainOptions).validate_json(path.read_bytes())) | given)
    except (OSError, ValueError) as error:
        raise ValueError(f'{path} holds no options of a run: {what_is_wrong(error)}') from error


def keep_options(options: TrainOptions, folder: Path) -> None:
    """Write them down in the folder of the run."""
    write_atomically(folder / OPTIONS_NAME, (json.dumps(asdict(options), indent=2) + '\n').encode())
