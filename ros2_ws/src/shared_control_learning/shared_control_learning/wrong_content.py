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

"""What is wrong with the content of a file, in words that are safe to print however long or strange it is."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError
from shared_control.printable import REASON_MAX, cut, escaped, shortened

PROBLEMS_MAX = 3
_WORDS = {
    'missing': 'is missing', 'unexpected_keyword_argument': 'is not known', 'extra_forbidden': 'is not known',
    'model_type': 'should be keys with values', 'dataclass_type': 'should be keys with values'}


def what_is_wrong(error: Exception) -> str:
    """An error in words; of pydantic's the first problems, with the key's path, what is expected and what is there."""
    if isinstance(error, ValidationError):
        return escaped('; '.join(
            _problem(problem) for problem in error.errors(include_url=False)[:PROBLEMS_MAX]))
    return escaped(cut(str(error) or type(error).__name__, REASON_MAX))


def _problem(problem: Mapping[str, Any]) -> str:
    kind = problem['type']
    path = '.'.join(shortened(key).strip('\'"') for key in problem['loc'] if key != '[key]')
    reason = cut(_WORDS.get(kind, problem['msg'].removeprefix('Value error, ')), REASON_MAX)
    if kind not in ('missing', 'value_error', 'json_invalid'):
        reason += f', found {shortened(problem["input"])}'
    return f'{path}: {reason}' if path else reason
