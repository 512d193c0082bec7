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

"""What becomes of the moments before they reach the arm."""

import numpy as np
import pytest
from shared_control.control.moments import FADE_TIME, MomentSource, freshness, sum_moments
from shared_control.control.sharing import WAYS, Sharing


def test_a_command_counts_until_its_timeout_and_then_fades():
    assert freshness(0.0, 0.1) == freshness(0.1, 0.1) == 1.0
    assert freshness(0.1 + FADE_TIME / 2, 0.1) == pytest.approx(0.5)
    assert freshness(0.1 + FADE_TIME, 0.1) == freshness(100.0, 0.1) == 0.0


def test_a_stamp_far_ahead_counts_nothing():
    """Time was set back: the simulator was started anew."""
    assert freshness(-0.1, 0.1) == 1.0
    assert freshness(-0.1001, 0.1) == freshness(-100.0, 0.1) == 0.0


def test_a_silent_source_ends_at_zero():
    source = MomentSource(2, 0.1)
    source.take(np.array([5.0, -2.0]), 1_000_000_000)
    np.testing.assert_array_equal(source.at(950_000_000), [5.0, -2.0])
    np.testing.assert_array_equal(source.at(1_050_000_000), [5.0, -2.0])
    assert 0.0 < source.at(1_150_000_000)[0] < 5.0
    assert source.age(1_150_000_000) == pytest.approx(0.15) and source.age(500_000_000) == pytest.approx(-0.5)
    np.testing.assert_array_equal(source.at(2_000_000_000), [0.0, 0.0])


@pytest.mark.parametrize('back_ms', [1, 90, 150, 1000])
def test_a_moment_does_not_come_back_with_the_time_at_which_it_was_sent(back_ms):
    """The robot's time is set back after the source has died, and runs on."""
    source = MomentSource(1, 0.1)
    source.take(np.array([5.0]), 2_000_000_000)
    assert source.at(2_000_000_000) == 5.0
    for ms in range(2000 - back_ms, 2500):
        assert source.at(ms * 1_000_000) == 0.0
    source.take(np.array([3.0]), 2_499_000_000)
    assert source.at(2_499_000_000) == 3.0


def test_a_moment_whose_stamp_was_far_ahead_is_forgotten():
    source = MomentSource(1, 0.1)
    source.take(np.array([5.0]), 2_000_000_000)
    for ms in range(1000, 2500):
        assert source.at(ms * 1_000_000) == 0.0


def test_the_sum_is_limited_about_each_axis():
    limit = np.array([20.0, 10.0])
    np.testing.assert_array_equal(sum_moments(np.array([3.0, -4.0]), np.array([5.0, 1.0]), limit), [8.0, -3.0])
    np.testing.assert_array_equal(sum_moments(np.array([30.0, -9.0]), np.array([5.0, -9.0]), limit), [20.0, -10.0])


@pytest.mark.parametrize(('way', 'agent', 'human'), [
    ('additive', [3.0, -4.0], [5.0, 0.0]), ('override', [0.0, 0.0], [5.0, 0.0]),
    ('blend', [0.75 * 3.0, 0.75 * -4.0], [0.25 * 5.0, 0.0]), ('axes', [0.0, -4.0], [5.0, 0.0])])
def test_what_counts_of_the_two_moments(way, agent, human):
    parts = Sharing(way, 0.25).parts(np.array([3.0, -4.0]), np.array([5.0, 0.0]))
    np.testing.assert_allclose(parts, [agent, human])


@pytest.mark.parametrize('way', [way for way in WAYS if way != 'axes'])
def test_a_person_who_lets_go_leaves_all_to_the_agent(way):
    np.testing.assert_array_equal(Sharing(way).parts(np.array([3.0]), np.zeros(1)), [[3.0], [0.0]])


def test_what_cannot_be_shared_is_refused():
    with pytest.raises(ValueError, match='additive, override, blend, axes'):
        Sharing('democratic')
    with pytest.raises(ValueError, match='expected 0 to 1'):
        Sharing('blend', 1.5)
    with pytest.raises(ValueError, match='plate'):
        Sharing('axes').check(1)
