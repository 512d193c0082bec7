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

"""YAML that people write: what a slip would drop in silence is an error."""

from typing import Any

import yaml

from .printable import shortened


class StrictLoader(yaml.SafeLoader):
    """YAML without a key that stands twice in the same mapping, of which the first would be dropped."""

    def compose_mapping_node(self, anchor: Any) -> Any:
        """See :class:`yaml.composer.Composer`; a ValueError names key and line."""
        node = super().compose_mapping_node(anchor)
        keys = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if (key.tag, key.value) in keys:
                    line = key.start_mark.line + 1
                    raise ValueError(f'line {line}: the key {shortened(key.value)} stands there twice')
                keys.add((key.tag, key.value))
        return node
