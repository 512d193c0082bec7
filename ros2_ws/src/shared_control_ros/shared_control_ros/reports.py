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

"""What a node's report on /diagnostics says."""

from collections.abc import Mapping
from typing import Any


def values_of(status: Any) -> dict[str, str]:
    """The values of a ``diagnostic_msgs/DiagnosticStatus`` by their keys."""
    return {value.key: value.value for value in status.values}


def waits_to_be_enabled(values: Mapping[str, str]) -> bool:
    """Whether a node does nothing until somebody enables it."""
    return values.get('enabled') == 'False' and values.get('enables_itself') != 'True'
