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

"""Keys to M_yh."""

import pytest
from shared_control.keys import MAX_SOURCES, Key, KeyMoment, KeyPresses, PressesBySource


def test_each_press_is_five_newton_metres_and_space_is_zero():
    moment = KeyMoment()
    moment.press(Key.LEFT)
    assert moment.moment.tolist() == [5.0]
    for _ in range(5):
        moment.press(Key.RIGHT)
    assert moment.moment.tolist() == [-10.0]
    moment.press(Key.SPACE)
    assert moment.moment.tolist() == [0.0]


def test_keys_of_two_axes_move_each_its_own():
    moment = KeyMoment({Key.LEFT: (1, 1.0), Key.RIGHT: (1, -1.0), Key.UP: (0, -1.0), Key.DOWN: (0, 1.0)})
    for key in (Key.LEFT, Key.UP, Key.UP):
        moment.press(key)
    assert moment.moment.tolist() == [-10.0, 5.0]
    moment.press(Key.SPACE)
    assert moment.moment.tolist() == [0.0, 0.0]


def test_a_key_that_moves_no_axis_does_nothing():
    moment = KeyMoment()
    moment.press(Key.UP)
    assert moment.moment.tolist() == [0.0]


def test_a_press_is_a_rising_edge():
    presses = KeyPresses()
    assert presses.update([1, 0, 0]) == [Key.LEFT]
    assert presses.update([1, 0, 0]) == []
    assert presses.update([0, 0, 1]) == [Key.SPACE]
    assert presses.update([1, 1, 0]) == [Key.LEFT, Key.RIGHT]


def test_too_few_buttons_are_refused():
    with pytest.raises(ValueError, match='3 buttons'):
        KeyPresses().update([1])


def test_sources_are_told_apart_as_long_as_they_are_not_too_many():
    presses = PressesBySource()
    assert presses.update('a', [1, 0, 0]) == [Key.LEFT] and presses.update('b', [1, 0, 0]) == [Key.LEFT]
    assert presses.update('a', [1, 0, 0]) == []
    presses.forget('a')
    assert presses.update('a', [1, 0, 0]) == [Key.LEFT]
    for number in range(10 * MAX_SOURCES):
        presses.update(f'made up {number}', [0, 0, 0])
        assert presses.update('b', [1, 0, 0]) == [], 'who is heard all the while'
    assert presses.update('a', [1, 0, 0]) == [Key.LEFT]
