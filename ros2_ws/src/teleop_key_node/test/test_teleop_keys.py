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

"""Bytes to strokes, and states of several sources to one moment."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shared_control.tasks.balance import BALANCE
from shared_control.teaching.key_device import KeyDevice
from teleop_key_node.keyboard import HeldKeys, Keyboard, Stroke
from teleop_key_node.sources import Sources

SECOND = 1_000_000_000


@pytest.mark.parametrize(('data', 'strokes'), [
    (b'\x1b[D\x1b[C', [Stroke.LEFT, Stroke.RIGHT]),
    (b'\x1bOD', [Stroke.LEFT]),
    (b'\x1b[1;5C', [Stroke.RIGHT]),
    (b'aAdD ', [Stroke.LEFT, Stroke.LEFT, Stroke.RIGHT, Stroke.RIGHT, Stroke.SPACE]),
    (b'qp\x0c', [Stroke.FINISH, Stroke.PAUSE, Stroke.REDRAW]),
    (b'\x1b[A\x1b[3~uyz\xc3\xa4\x1b[200~', []),
    (b'\x1ba', [Stroke.LEFT]),
    (b'\x1b[[A\x1b[[C\x1b[[Da', [Stroke.LEFT]),  # F1, F3, F4 of the Linux console
    (b'\x1bOP\x1b[15~\x1b[1;2Pa', [Stroke.LEFT]),
    (b'\x1b]11;rgb:1a1a/2d2d/adda\x1b\\a', [Stroke.LEFT]),
    (b'\x1b]0;a title, paused\x07d', [Stroke.RIGHT]),
    (b'\x1bP1$r0 q\x1b\\a', [Stroke.LEFT]),
    (b'\x1b[M daa', [Stroke.LEFT]),  # X10 mouse
    (b'\x1b[<0;10;20Ma', [Stroke.LEFT]),
    (b'\x1b[200~add a pq\x1b[D\x1b[201~a', [Stroke.LEFT]),
    (b'\x1b[5;3Dd\x1b[?62;c\x1b[24;80R', [Stroke.RIGHT]),
])
def test_strokes(data, strokes):
    assert Keyboard().strokes(data) == strokes
    keyboard = Keyboard()
    assert [stroke for i in range(len(data)) for stroke in keyboard.strokes(data[i:i + 1])] == strokes


def test_a_task_with_two_axes_has_up_and_down():
    assert Keyboard(unknown=()).strokes(b'\x1b[Aw\x1b[Bs') == [Stroke.UP, Stroke.UP, Stroke.DOWN, Stroke.DOWN]


def test_what_is_typed_after_escape_is_a_key(monkeypatch):
    now = 100.0
    monkeypatch.setattr('teleop_key_node.keyboard.time.monotonic', lambda: now)
    keyboard = Keyboard()
    assert keyboard.strokes(b'\x1bP') == []  # may begin a string
    now += 0.5
    assert keyboard.strokes(b'a') == [Stroke.LEFT]


def presses(times, look=0.02, stroke=Stroke.LEFT):
    """Presses of a key whose strokes come at ``times``, looked at every ``look`` s."""
    held, now, count, end = HeldKeys(0.02), 100.0, 0, 100.0 + max(times) + 5 * look + 0.2
    while now < end:
        now += look
        due = [t for t in times if 100.0 + t <= now]
        times = times[len(due):]
        count += len(held.update([stroke] * len(due), now))
    assert not held.down
    return count


@pytest.mark.parametrize('period', [1 / 30, 1 / 25, 0.092])
def test_repetitions_of_a_held_key_are_no_presses(period):
    repeats = [0.5 + period * count for count in range(round(3 / period))]
    assert presses([0.0, *repeats]) == 2, 'the press, and the late first repetition'
    for look in (0.05, 0.09, 0.2, 0.5):
        assert presses(repeats, look) == 1, 'on a busy machine, too'


@pytest.mark.parametrize('period', [1 / 30, 1 / 25, 0.092])
@pytest.mark.parametrize('first', [0.25, 0.5, 0.7])
@pytest.mark.parametrize('look', [0.02, 0.09, 0.2])
def test_a_key_that_asks_is_pressed_once_however_long_it_is_held(period, first, look):
    """q, held, would answer its own question; x, held, would take back that the episode is discarded."""
    repeats = [first + period * count for count in range(round(3 / period))]
    assert presses([0.0, *repeats], look, stroke=Stroke.FINISH) == 1
    assert presses([0.0, *repeats, first + 5.0], look, stroke=Stroke.FINISH) == 2


def test_a_key_that_asks_may_be_pressed_twice_in_a_row():
    for apart in (0.2, 0.4, 0.75, 2.0):
        assert presses([apart * count for count in range(6)], stroke=Stroke.FINISH) == 6


def test_quick_presses_of_a_person_all_count():
    assert presses([0.15 * count for count in range(20)]) == 20
    assert presses([0.6 * count for count in range(20)], look=0.2) == 20, 'on a busy machine, if they are not so quick'


def test_each_key_is_held_on_its_own():
    held = HeldKeys(0.02)
    assert held.update([Stroke.LEFT, Stroke.SPACE, Stroke.LEFT], 10.0) == [Stroke.LEFT, Stroke.SPACE]
    assert set(held.down) == {Stroke.LEFT, Stroke.SPACE}
    assert held.update([Stroke.RIGHT], 10.05) == [Stroke.RIGHT]


class Broken(KeyDevice):
    """Somebody's device that makes nonsense of a press."""

    @property
    def moment(self):
        return super().moment * float('inf')


def test_a_device_that_makes_nonsense_is_named_and_let_go():
    device = Broken(BALANCE)
    sources = Sources(device, timeout=0.5)
    with pytest.raises(ValueError, match='the device makes'):
        sources.hear('a', [], [1, 0, 0], 0, 0.0)
    assert not KeyDevice.moment.fget(device).any()


def test_a_silent_source_is_forgotten_and_others_stay():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('a', [], [1, 0, 0], 0, 0.0)
    sources.hear('b', [], [0, 0, 0], SECOND, 1.0)
    assert sources.drop_silent(SECOND, 1.0) == ['a']
    assert sources.moment[0] == 0.0
    sources.hear('b', [], [1, 0, 0], SECOND, 1.0)
    sources.hear('c', [], [0, 0, 0], SECOND, 1.0)
    sources.hear('b', [], [1, 0, 0], 2 * SECOND, 2.0)
    assert sources.drop_silent(2 * SECOND, 2.0) == [], 'c never pressed'
    assert sources.moment[0] == 5.0


def test_whoever_left_before_the_moment_was_zero_takes_nothing_away():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('page', [], [1, 0, 0], 0, 0.0)
    sources.hear('page', [], [0, 0, 0], 0, 0.0)
    sources.hear('terminal', [], [0, 0, 1], 0, 0.0)
    sources.hear('terminal', [], [0, 0, 0], 0, 0.0)
    sources.hear('terminal', [], [0, 1, 0], SECOND // 2, 0.5)
    sources.hear('terminal', [], [0, 1, 0], SECOND, 1.0)
    assert sources.drop_silent(SECOND, 1.0) == []
    assert sources.moment[0] == -5.0


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(
    st.sampled_from('ab'), st.sampled_from([-1.0, 0.0, 1.0]),
    st.sampled_from([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]))))
def test_nobody_leaves_a_moment_behind_whatever_they_did(states):
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    for source, stick, buttons in states:
        sources.hear(source, [stick], buttons, 0, 0.0)
    sources.leave('b')
    if not any(source == 'a' and (stick or any(buttons)) for source, stick, buttons in states):
        assert not sources.moment.any()
    sources.drop_silent(SECOND, 1.0)
    assert not sources.moment.any()


def test_a_push_that_a_stick_has_balanced_goes_with_whoever_made_it():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    for buttons in ([0, 1, 0], [0, 0, 0], [0, 1, 0], [0, 0, 0]):
        sources.hear('terminal', [], buttons, 0, 0.0)
    sources.hear('pad', [1.0], [0, 0, 0], 0, 0.0)
    assert not sources.moment.any()
    sources.hear('terminal', [], [0, 0, 0], 0, 0.0)
    sources.hear('pad', [0.0], [0, 0, 0], SECOND, 1.0)
    assert sources.moment.tolist() == [-10.0]
    assert sources.drop_silent(SECOND, 1.0) == ['terminal']
    assert not sources.moment.any()


def test_whoever_lets_go_takes_away_what_was_held_and_no_more():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('page', [], [1, 0, 0], 0, 0.0)
    sources.leave('terminal')
    assert sources.moment[0] == 5.0
    sources.leave('page')
    assert sources.moment[0] == 0.0
    sources.hear('page', [], [1, 0, 0], 0, 0.0)
    assert sources.moment[0] == 5.0, 'pressed anew'


def test_whoever_leaves_while_time_stands_still_takes_the_moment_along():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('page', [], [1, 0, 0], SECOND, 10.0)
    assert sources.drop_silent(SECOND, 11.9) == [], 'a machine may be held up'
    assert sources.drop_silent(SECOND, 12.1) == ['page']
    assert sources.moment[0] == 0.0


def test_a_clock_that_jumps_back_makes_every_source_silent():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.hear('a', [], [1, 0, 0], 9 * SECOND, 9.0)
    assert sources.drop_silent(SECOND, 1.0) == ['a']
    assert sources.moment[0] == 0.0


def test_a_key_held_over_the_start_of_an_episode_is_no_press():
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    sources.is_active = False
    sources.hear('a', [], [1, 0, 0], 0, 0.0)
    sources.is_active = True
    sources.hear('a', [], [1, 0, 0], 0, 0.0)
    assert sources.moment[0] == 0.0
    sources.hear('a', [], [0, 0, 0], 0, 0.0)
    sources.hear('a', [], [1, 0, 0], 0, 0.0)
    assert sources.moment[0] == 5.0
