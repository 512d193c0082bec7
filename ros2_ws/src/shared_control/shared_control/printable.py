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

"""Text from files of others in messages, safe to print however long or strange it is."""

import reprlib
from typing import Any

ECHO_MAX = 100
"""Characters of content that are repeated."""
REASON_MAX = 500
"""Characters of a reason."""
_repr = reprlib.Repr()
_repr.maxlevel, _repr.maxstring, _repr.maxother = 3, ECHO_MAX, ECHO_MAX


def shortened(value: Any) -> str:
    """The repr of a value, cut: control characters are escaped in it, and nested content is not expanded."""
    try:
        return cut(_repr.repr(value), ECHO_MAX)
    except ValueError:  # Python does not print whole numbers of more than 4300 digits
        return 'a very large number'


def escaped(text: str) -> str:
    """A text whose control characters, but for line breaks and tabs, are written as in a Python string.

    A terminal would take them for commands: to set its title, to hide what follows.
    """
    return ''.join(character if character.isprintable() or character in '\n\t'
                   else character.encode('unicode_escape').decode() for character in text)


def cut(text: str, most: int) -> str:
    """A text of at most so many characters."""
    return text if len(text) <= most else f'{text[:most - 3]}...'
