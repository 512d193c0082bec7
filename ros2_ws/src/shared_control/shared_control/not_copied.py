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

"""What cannot be copied says so, instead of sharing or losing what it stands on."""

from typing import Any, NoReturn


class NotCopied:
    """An object with parts that ``copy`` and ``pickle`` know nothing of: an engine's world, views into its memory."""

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        """Refuse ``copy.copy``, ``copy.deepcopy`` and ``pickle``.

        Raises:
            TypeError: always.
        """
        raise TypeError(f'a {type(self).__name__} cannot be copied or pickled: make another one')
