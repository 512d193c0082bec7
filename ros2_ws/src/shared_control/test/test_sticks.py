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

"""Sticks: what is nothing, what is how much, and which of a driver's axes and buttons are which."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shared_control.keys import LEFT_AND_RIGHT, Key
from shared_control.sticks import DEAD_BAND, JoyMapping, StickMoment
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.plate import Plate
from shared_control.teaching.key_device import KeyDevice

PLATE = Plate()
BOTH = st.lists(st.floats(-1.0, 1.0), max_size=4)


@pytest.mark.parametrize('keys', [BALANCE.keys, PLATE.keys])
def test_a_stick_gives_what_the_keys_give_all_the_way(keys):
    stick = StickMoment(keys, limit=8.0)
    for key, axes in ((Key.LEFT, [1.0, 0.0]), (Key.RIGHT, [-1.0, 0.0]), (Key.UP, [0.0, 1.0]), (Key.DOWN, [0.0, -1.0])):
        expected = np.zeros(1 + max(axis for axis, _ in keys.values()))
        if key in keys:
            axis, sign = keys[key]
            expected[axis] = 8.0 * sign
        np.testing.assert_allclose(stick.of(axes), expected)


@given(BOTH)
def test_at_rest_it_is_nothing_and_never_more_than_the_limit(axes):
    moment = StickMoment(PLATE.keys, limit=8.0).of(axes)
    assert (np.abs(moment) <= 8.0).all()
    held = {PLATE.keys[key][0] for key, value in zip((Key.LEFT, Key.UP), axes, strict=False) if abs(value) > DEAD_BAND}
    assert set(np.flatnonzero(moment)) == held


def test_a_curve_makes_small_moments_finer():
    plain, curved = (StickMoment(LEFT_AND_RIGHT, 10.0, 0.0, curve).of([0.5])[0] for curve in (1.0, 2.0))
    assert (plain, curved) == (5.0, 2.5)


@pytest.mark.parametrize('axes', [[math.nan], [1.5, 0.0], [0.0, -math.inf]])
def test_nonsense_is_refused(axes):
    with pytest.raises(ValueError, match='axes of -1 to 1'):
        StickMoment(PLATE.keys).of(axes)
    device = KeyDevice(BALANCE)
    device.update('pad', [0.0, 0.0], [1, 0, 0])
    if math.isnan(axes[0]) or len(axes) > 1:
        with pytest.raises(ValueError, match='axes of -1 to 1'):
            device.update('pad', axes, [0, 1, 0])
    assert device.moment[0] == 5.0, 'it changes nothing'


def test_keys_and_sticks_of_several_sources_add_up_to_the_limit():
    device = KeyDevice(BALANCE, keystroke=5.0, limit=10.0, dead_band=0.0)
    assert device.update('terminal', [], [1, 0, 0])
    assert device.update('pad', [-0.3], [0, 0, 0])
    assert device.moment[0] == pytest.approx(2.0)
    assert device.update('page', [1.0, 0.0], [0, 0, 0])
    assert device.moment[0] == 10.0
    device.forget('page')
    assert device.moment[0] == pytest.approx(2.0)
    assert not device.update('pad', [0.0], [0, 0, 0]), 'it rests'
    assert device.moment[0] == 5.0
    device.update('pad', [1.0], [0, 0, 0])
    device.release()
    assert device.moment[0] == 0.0


def test_a_gamepad_a_space_mouse_and_a_pedal():
    gamepad = JoyMapping(buttons=(13, 14, 0, 11, 12))
    assert gamepad.axes([0.5, -0.25, 1.0]) == [0.5, -0.25]
    assert gamepad.buttons([1] + 12 * [0] + [1, 0]) == [1, 0, 1, 0, 0, *8 * [0], 1, 0], 'its others keep their numbers'
    mouse = JoyMapping(axes=(1, 0), scale=(2.0, -2.0))
    assert mouse.axes([0.2, 0.7]) == [1.0, pytest.approx(-0.4)]
    pedal = JoyMapping(buttons=5 * (-1,), axes=(2, -1), scale=(0.5, 1.0), rest=(-1.0, 0.0))
    assert pedal.axes([0.3, 0.3, -1.0]) == [0.0, 0.0] and pedal.axes([0.3, 0.3, 1.0]) == [1.0, 0.0]
    assert pedal.axes([]) == [0.0, 0.0] and pedal.buttons([]) == 5 * [0]


@pytest.mark.parametrize('value', [math.nan, math.inf])
def test_a_driver_that_has_lost_its_stick_holds_nothing_all_the_way(value):
    with pytest.raises(ValueError, match='expected finite axes'):
        JoyMapping().axes([value, 0.0])
    assert JoyMapping(axes=(1, -1)).axes([value, 0.5]) == [0.5, 0.0], 'an axis that counts for nothing may be anything'


@pytest.mark.parametrize(('options', 'said'), [
    ({'buttons': (0, 1)}, r'buttons is \[0, 1\], expected 5 numbers'),
    ({'axes': (0, 1, 2)}, r'axes is \[0, 1, 2\], expected 2'), ({'scale': (1.0, math.nan)}, 'scale is'),
])
def test_a_mapping_that_cannot_be_is_named(options, said):
    with pytest.raises(ValueError, match=said):
        JoyMapping(**options)
