"""Bytes to strokes, and states of several sources to one moment."""

import pytest
from shared_control.tasks.balance import BALANCE
from shared_control.teaching.key_device import KeyDevice
from teleop_key_node.keyboard import Keyboard, Stroke
from teleop_key_node.sources import Sources

SECOND = 1_000_000_000


@pytest.mark.parametrize(('data', 'strokes'), [
    (b'\x1b[D\x1b[C', [Stroke.LEFT, Stroke.RIGHT]),
    (b'\x1bOD', [Stroke.LEFT]),
    (b'\x1b[1;5C', [Stroke.RIGHT]),
    (b'aAdD ', [Stroke.LEFT, Stroke.LEFT, Stroke.RIGHT, Stroke.RIGHT, Stroke.SPACE]),
    (b'qp\x0c', [Stroke.FINISH, Stroke.PAUSE, Stroke.REDRAW]),
    (b'\x1b[A\x1b[3~xyz\xc3\xa4\x1b[200~', []),
    (b'\x1ba', [Stroke.LEFT]),
])
def test_strokes(data, strokes):
    assert Keyboard().strokes(data) == strokes
    keyboard = Keyboard()
    assert [stroke for i in range(len(data)) for stroke in keyboard.strokes(data[i:i + 1])] == strokes


def test_a_task_with_two_axes_has_up_and_down():
    assert Keyboard(unknown=()).strokes(b'\x1b[Aw\x1b[Bs') == [Stroke.UP, Stroke.UP, Stroke.DOWN, Stroke.DOWN]


class Broken(KeyDevice):
    """Somebody's device that makes nonsense of a press."""

    @property
    def moment(self):
        return super().moment * float('inf')


def test_a_device_that_makes_nonsense_is_named_and_let_go():
    device = Broken(BALANCE)
    sources = Sources(device, timeout=0.5)
    with pytest.raises(ValueError, match='the device makes'):
        sources.hear('a', [], [1, 0, 0], 0)
    assert not KeyDevice.moment.fget(device).any()


def test_a_silent_source_is_forgotten_and_others_stay():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('a', [], [1, 0, 0], 0)
    sources.hear('b', [], [0, 0, 0], SECOND)
    assert sources.drop_silent(SECOND) == ['a']
    assert sources.moment[0] == 0.0
    sources.hear('b', [], [1, 0, 0], SECOND)
    sources.hear('c', [], [0, 0, 0], SECOND)
    sources.hear('b', [], [1, 0, 0], 2 * SECOND)
    assert sources.drop_silent(2 * SECOND) == [], 'c never pressed'
    assert sources.moment[0] == 5.0


def test_whoever_left_before_the_moment_was_zero_takes_nothing_away():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('page', [], [1, 0, 0], 0)
    sources.hear('terminal', [], [0, 0, 1], 0)
    sources.hear('terminal', [], [0, 1, 0], SECOND // 2)
    sources.hear('terminal', [], [0, 1, 0], SECOND)
    assert sources.drop_silent(SECOND) == []
    assert sources.moment[0] == -5.0


def test_a_clock_that_jumps_back_makes_every_source_silent():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('a', [], [1, 0, 0], 9 * SECOND)
    assert sources.drop_silent(SECOND) == ['a']
    assert sources.moment[0] == 0.0


def test_a_key_held_over_the_start_of_an_episode_is_no_press():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.is_active = False
    sources.hear('a', [], [1, 0, 0], 0)
    sources.is_active = True
    sources.hear('a', [], [1, 0, 0], 0)
    assert sources.moment[0] == 0.0
    sources.hear('a', [], [0, 0, 0], 0)
    sources.hear('a', [], [1, 0, 0], 0)
    assert sources.moment[0] == 5.0
