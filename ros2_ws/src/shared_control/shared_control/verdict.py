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

"""What a person says of an episode that has ended."""

from enum import StrEnum


class Verdict(StrEnum):
    """A word on ``/human/verdict`` and ``/training/verdict``: a label, which changes neither reward nor task."""

    NONE = ''
    """Nothing was said, or it was taken back."""
    SUCCESS = 'success'
    FAILURE = 'failure'
    DISCARD = 'discard'
    """It does not count: nobody is to learn from it."""

    def after(self, said: 'Verdict') -> 'Verdict':
        """What stands when ``said`` comes on top of this: the same again takes it back."""
        return Verdict.NONE if said is self else said


def episode_key(phase: str, number: int) -> str:
    """What ``/training/verdict`` calls an episode, such as ``teach 4``."""
    return f'{phase} {number}'


def split_episode_key(key: str) -> tuple[str, int]:
    """Phase and number of the episode that :func:`episode_key` names.

    Raises:
        ValueError: it is no such name.
    """
    phase, _, number = key.partition(' ')
    return phase, int(number)
