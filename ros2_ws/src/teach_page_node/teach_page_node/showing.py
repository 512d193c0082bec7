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

"""What of a lesson or a recording people are shown."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Showing:
    """What a page shows, besides what moves."""

    feedback: str = 'full'
    """One of :data:`shared_control.teaching.feedback.FEEDBACK`."""
    verdicts: bool = True
    """Whether the person is offered to judge episodes."""
    in_session: bool = False
    """A lesson is about to be given: nothing known of it means that it starts."""
    shows_result: bool = True
    """Whether test, picture and report are shown in the end."""
    title: str = ''
    """Which recording this is."""
    marks: tuple[tuple[float, str, str], ...] = ()
    """Where its episodes begin, s, their names, and a person's verdicts."""
    tested: str = ''
    """What the robot alone came to in the test of the recorded session."""
