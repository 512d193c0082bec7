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
from shared_control.keys import Key, KeyMoment, KeyPresses


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
