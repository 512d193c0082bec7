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

"""When a practice is enough."""

import pytest
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE
from shared_control_learning.practice import REST_SECONDS, Practice

REST = round(REST_SECONDS / POLICY_PERIOD)
THERE, BESIDE = 0.019, 0.021
"""m; the goal's radius is 20 mm."""


def steps(practice, *positions):
    return [practice.step(position) for position in positions]


@pytest.mark.parametrize('side', [1, -1])
def test_a_ball_is_at_rest_after_three_seconds_at_the_goal(side):
    practice = Practice(BALANCE, 2, 300.0)
    assert steps(practice, *[side * THERE] * REST) == [False] * (REST - 1) + [True]
    assert (practice.rests, practice.left) == (1, 1)
    assert not any(steps(practice, *[THERE] * (REST - 1))), 'the next one takes as long'
    assert practice.step(THERE) and practice.left == 0
    assert practice.as_dict() == {'rests': 2, 'wanted': 2, 'met': True, 'seconds': 2 * REST_SECONDS}


def test_leaving_the_goal_or_a_new_ball_begins_the_count_anew():
    practice = Practice(BALANCE, 1, 300.0)
    assert not any(steps(practice, *[THERE] * (REST - 1), -BESIDE, *[THERE] * (REST - 1)))
    practice.begin()
    assert not practice.step(THERE) and practice.left == 1


def test_after_its_time_a_practice_is_enough_and_says_that_the_criterion_was_not_met():
    practice = Practice(BALANCE, 1, 1.0)
    steps(practice, *[BESIDE] * 49)
    assert practice.left == 1
    practice.step(BESIDE)
    assert practice.left == 0 and practice.as_dict()['met'] is False


def test_without_a_criterion_it_may_end_at_once():
    assert Practice(BALANCE, 0, 300.0).left == 0
