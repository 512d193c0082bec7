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

"""What a person is told of each phase: the same words on the page, in the terminal and in a replay. Needs no ROS."""

from typing import NamedTuple

from shared_control.tasks.task import Task
from shared_control.verdict import Verdict


class Words(NamedTuple):
    """Title and explanation of one phase."""

    title: str
    doing: str
    """What happens, and whether keys count."""


STARTING = Words('Starting', 'Robot and learner are getting ready.')
"""A session has begun, and the agent has said nothing yet."""
NO_LESSON = Words('No lesson', 'Nobody learns at the moment; your keys move the tray.')
STANDS_STILL = 'The robot stands still.'
STUCK_SECONDS = 3.0
"""After this much silence of the robot people are told to call somebody."""
STUCK = 'The robot has stopped answering ({seconds} s). Please tell the experimenter.'
PHASES = {
    'wait': Words('Get ready', 'An episode is about to begin. Your keys do not count yet.'),
    'practice': Words('Practice', 'You alone move the tray: the robot is off. Get the feel of it.'),
    'teach': Words('Teach', 'The robot tries. Push when it errs; no push when it does well.'),
    'learn': Words('The robot learns', 'Your keys do not count now.'),
    'test': Words('The robot alone', 'Hands off: see what it has learned. Your keys do not count now.'),
    'done': Words('Finished', 'The teaching is over.'),
}


def practice_words(rests_left: int) -> str:
    """What is still to be done in a practice that has a criterion; otherwise, or once that is met, that it may end."""
    if rests_left:
        times = {1: 'once', 2: 'twice'}.get(rests_left, f'{rests_left} times')
        return f'Alone, bring the ball to rest on the mark for 3 s, {times} more.'
    return PHASES['practice'].doing


def words_for(task: Task) -> dict[str, Words]:
    """The words of all phases, by name."""
    if len(task.axes) == 1:
        return PHASES
    teach = PHASES['teach']
    return {**PHASES, 'teach': Words(teach.title, f'{task.instruction} Push when the robot errs.')}


NOTHING_TO_JUDGE = 'No episode has ended yet: there is nothing to judge.'
ALL_TESTS_COUNT = 'An episode of a test cannot be discarded: all count.'


def words_of_verdict(phase: str, number: int, verdict: Verdict, is_running: bool) -> str:
    """What has become of an episode by a person's verdict.

    Args:
        is_running: whether the next episode has begun, so that the robot keeps what it has learned.
    """
    what = f'{"Test" if phase == "test" else "Episode"} {number}'
    if verdict is Verdict.DISCARD:
        return f'{what} is discarded: ' + (
            'it counts nowhere, but the robot has learned from it.' if is_running else
            'the robot forgets it. The same again keeps it.')
    word = {Verdict.SUCCESS: 'good', Verdict.FAILURE: 'bad'}.get(verdict)
    return f'{what}: {word}.' if word else f'{what}: your verdict is taken back.'
