"""Keys to M_yh."""

import pytest
from shared_control.teaching.keys import Key, KeyMoment, KeyPresses


def test_each_press_is_five_newton_metres_and_space_is_zero():
    moment = KeyMoment()
    moment.press(Key.LEFT)
    assert moment.m_y == 5.0
    for _ in range(5):
        moment.press(Key.RIGHT)
    assert moment.m_y == -10.0
    moment.press(Key.SPACE)
    assert moment.m_y == 0.0


def test_a_press_is_a_rising_edge():
    presses = KeyPresses()
    assert presses.update([1, 0, 0]) == [Key.LEFT]
    assert presses.update([1, 0, 0]) == []
    assert presses.update([0, 0, 1]) == [Key.SPACE]
    assert presses.update([1, 1, 0]) == [Key.LEFT, Key.RIGHT]


def test_too_few_buttons_are_refused():
    with pytest.raises(ValueError, match='3 buttons'):
        KeyPresses().update([1])
